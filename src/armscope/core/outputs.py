"""What a command writes appears together when it has ended well, or not at all; and it is never somebody else's.

A command's files are made ready in a hidden folder ``.armscope`` beside the place they are for, and put there when the
command has ended well. That folder also holds, by command, names and digests of what was put there, by which armscope
knows its own: it replaces and tidies away what it wrote itself, and nothing else. What a killed run left behind is
finished by the next run, if it had begun to put its files in place, and else removed.
"""

from __future__ import annotations

import contextlib
import errno
import os
import sys
from collections.abc import Iterable, Iterator
from contextvars import ContextVar
from pathlib import Path

from armscope.core.inputs import FILES_READ, InputError, identity
from armscope.core.locks import Lock
from armscope.core.records import HIDDEN, carry_out, digest_of, drop_drafts, read_record, tidy, write_record
from armscope.core.streams import is_stream

OF_THE_DISK = (errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EIO)
"""What is wrong with the disk, and with no name that a user gave."""

_CURRENT: ContextVar[Delivery | None] = ContextVar("delivery", default=None)


def current() -> Delivery | None:
    """The delivery of the command that runs, if one does."""
    return _CURRENT.get()


def readable(path: Path | str) -> Path:
    """Where a file can be read that the command that runs may have made ready a moment ago."""
    delivery = current()
    made = None if delivery is None else delivery.made(path)
    return Path(path) if made is None else made


def unwritable(folder: Path | str, error: OSError | None = None) -> InputError:
    """That nothing can be written into a folder, and why: a link that leads to itself or nowhere, or what was told."""
    chain = [path for path in (Path(folder), *Path(folder).parents) if path.is_symlink()]
    broken = next((path for path in chain if not path.exists()), None)
    cure = ""
    if broken is not None:
        to = os.readlink(broken)
        ends = "to itself" if (broken.parent / to).is_symlink() else "nowhere"
        cure = f"{broken} is a link to {to}, which leads {ends}: remove it."
    told = "" if error is None or cure else f" ({error.strerror})"
    return InputError(folder, "", "no folder that can be written to", f"output goes into this folder{told}", cure)


class Result:
    """The files of one output (a folder or a file and what stands beside it).

    Args:
        place: the folder or file that the user named.
        command: which command writes it.
    """

    def __init__(self, place: Path, command: str) -> None:
        self.place, self.command = place, command
        self.is_new = not os.path.lexists(place)
        self.home = place if place.is_dir() else place.parent
        self.key = command.replace(" ", "-") if place.is_dir() else place.name
        self.names: set[str] = set()
        self._made_folders: list[Path] = []
        self._lock = Lock(self._hidden(".lock"), f"{place}: armscope {command} cannot write there now")

    def _hidden(self, ending: str) -> Path:
        return self.home / HIDDEN / f"{self.key}{ending}"

    def open(self) -> None:
        """Take the place's lock, and tidy up after runs that were killed. Raises Busy: another process writes there;
        InputError: nothing can be written there; OSError: the disk is full, read-only or broken."""
        try:
            try:
                self._make_folders()
                self._lock.take()
            except FileNotFoundError:  # another run has just tidied the hidden folder away
                self._make_folders()
                self._lock.take()
        except OSError as error:
            self._forget_folders()
            if error.errno in OF_THE_DISK:
                raise
            raise unwritable(self.home, error) from error
        tidy(self.home, self.key)

    def name_of(self, path: Path) -> str | None:
        """The name, seen from the result's home, under which a path belongs to this result; None if it doesn't."""
        for candidate in (Path(os.path.realpath(path.parent), path.name), Path(os.path.realpath(path))):
            if candidate == self.place or self.place in candidate.parents or candidate.parent == self.place.parent:
                with contextlib.suppress(ValueError):
                    return candidate.relative_to(self.home).as_posix()
        return None

    def staged(self, name: str) -> Path:
        """Where a file of this name is made ready."""
        return self._hidden(".new") / name

    def own(self) -> dict[str, str]:
        """What this command put here the last time: digest by name."""
        return read_record(self._hidden(".json"))

    def check(self, name: str, inputs: set[tuple[int, int]], force: bool) -> None:
        """Whether a name may be written.

        Args:
            name: seen from the result's home.
            inputs: identities of the command's inputs.
            force: overwrite files that armscope did not write.

        Raises:
            InputError: it is an input of the same command, or there is a file that this command did not write.
        """
        path = self.home / name
        if not path.exists():
            return
        if identity(path) in inputs:
            raise InputError(path, "", "an input of this command", "the output goes to a place of its own")
        if path.is_dir():
            raise InputError(path, "", "a folder", "a file is written under this name")
        if force or is_stream(path):
            return
        made, digest = self.staged(name), digest_of(path)
        if digest == self.own().get(name) or (made.is_file() and digest == digest_of(made)):
            return
        cure = "Choose another output, or give --force to overwrite it."
        raise InputError(path, "", self._whose(name), "armscope overwrites only what it wrote itself", cure)

    def _whose(self, name: str) -> str:
        if name in self.own():
            return "a file that was changed since armscope wrote it"
        for record in (self.home / HIDDEN).glob("*.json"):
            if name in read_record(record):
                return f"a file of another armscope result ({record.stem})"
        return "a file that armscope did not write"

    def put(self) -> None:
        """Put what was made ready in its place, and take away what an earlier run of this command left there."""
        stage = self._hidden(".new")
        digests = {name: digest_of(self.staged(name)) for name in sorted(self.names)}
        inside = f"{self.place.name}/"
        if self.is_new and all(name.startswith(inside) for name in digests):
            # a new folder appears whole, in one step
            record = {name.removeprefix(inside): digest for name, digest in digests.items()}
            records = stage / self.place.name / HIDDEN
            records.mkdir()
            write_record(records / f"{self.command.replace(' ', '-')}.json", {"files": record})
            try:
                os.rename(stage / self.place.name, self.place)
            except OSError as error:
                rule = f"the folder was not there when the command began ({error.strerror})"
                raise InputError(self.place, "", "something that came meanwhile", rule) from error
            return
        drop = {name: digest for name, digest in self.own().items() if name not in digests}
        write_record(self._hidden(".plan"), {"files": digests, "drop": drop})
        carry_out(self.home, self.key)

    def close(self) -> None:
        """Leave nothing behind but what was put in place."""
        if not self._hidden(".plan").exists():  # else the next run finishes what a full disk may have interrupted
            drop_drafts(self.home, self.key)
        self._lock.give_back()
        self._forget_folders()

    def _make_folders(self) -> None:
        for folder in reversed([self.home / HIDDEN, *(self.home / HIDDEN).parents]):
            if not folder.exists():
                folder.mkdir(exist_ok=True)
                self._made_folders.append(folder)

    def _forget_folders(self) -> None:
        """Folders that were made for nothing go."""
        for folder in (self.home / HIDDEN, *reversed(self._made_folders)):
            with contextlib.suppress(OSError):
                folder.rmdir()


class Delivery:
    """All that one command writes.

    Args:
        command: its name on the command line.
        inputs: files that it reads; more are noted as it reads them.
        outputs: the folders and files that it was asked to write.
        force: overwrite files that armscope did not write; never an input.
    """

    def __init__(self, command: str, inputs: Iterable[Path], outputs: Iterable[Path], force: bool = False) -> None:
        self.stdout = sys.stdout
        self.force = force
        self._inputs: set[tuple[int, int]] = set()
        for path in inputs:
            self.note_input(path)
        places = dict.fromkeys(Path(os.path.realpath(path)) for path in outputs if not is_stream(path))
        self.results = [Result(place, command) for place in places]

    def note_input(self, path: Path | str) -> None:
        """A file that must not be overwritten, known by its identity: other names and links count."""
        if (found := identity(path)) is not None:
            self._inputs.add(found)

    @contextlib.contextmanager
    def running(self) -> Iterator[Delivery]:
        """Between opening and closing all results; what is put in place is up to `put`."""
        opened: list[Result] = []
        token, reading = _CURRENT.set(self), FILES_READ.set(self._inputs)
        try:
            for result in self.results:
                result.open()
                opened.append(result)
                if not result.place.is_dir():
                    result.check(result.place.relative_to(result.home).as_posix(), self._inputs, self.force)
            yield self
        finally:
            _CURRENT.reset(token)
            FILES_READ.reset(reading)
            for result in opened:
                result.close()

    def expect(self, folder: Path, names: Iterable[str]) -> bool:
        """Before long work: whether a folder is an output of the command. Raises InputError: files of these names,
        or of those of the last time, may not be written there."""
        for result in self.results:
            if result.place == Path(os.path.realpath(folder)):
                if result.home == result.place:
                    for name in sorted({*names, *result.own()}):
                        result.check(name, self._inputs, self.force)
                elif not result.is_new:
                    raise unwritable(folder)
                return True
        return False

    def stage(self, path: Path | str) -> Path | None:
        """Where to make a file ready; None for one that belongs to no output of the command, as in a temporary
        folder. Raises InputError: it may not be written."""
        if (found := self._of(path)) is None:
            if identity(path) in self._inputs:
                raise InputError(path, "", "an input of this command", "the output goes to a place of its own")
            return None
        result, name = found
        result.check(name, self._inputs, self.force)
        staged = result.staged(name)
        staged.parent.mkdir(parents=True, exist_ok=True)
        return staged

    def keep(self, path: Path | str) -> None:
        """What was made ready for this path is whole."""
        if (found := self._of(path)) is not None:
            found[0].names.add(found[1])

    def made(self, path: Path | str) -> Path | None:
        """The file made ready for a path, if there is one."""
        found = self._of(path)
        return found[0].staged(found[1]) if found is not None and found[1] in found[0].names else None

    def put(self) -> None:
        """Put all files in place. Raises InputError: one of them may not be written; then none is."""
        for result in self.results:
            for name in result.names:
                result.check(name, self._inputs, self.force)
        for result in self.results:
            if result.names:
                result.put()

    def _of(self, path: Path | str) -> tuple[Result, str] | None:
        real = Path(os.path.realpath(path))
        # its own output first, then the folder that it lies in, then the file that it stands beside
        ranked = sorted(self.results, key=lambda each: (each.place != real, each.place not in real.parents))
        for result in ranked:
            if (name := result.name_of(Path(path))) is not None:
                return result, name
        return None
