"""Fetching public recordings: by repository, commit and path, each file checked by its sha256, whole or not at all."""

from __future__ import annotations

import gzip
import shutil
import urllib.error
import urllib.parse
import urllib.request
from dataclasses import dataclass
from http.client import HTTPException
from pathlib import Path, PurePosixPath
from typing import Annotated

from pydantic import Field

from armscope.core.files import replacing
from armscope.core.inputs import InputError, Strict, load
from armscope.core.records import digest_of
from armscope.recordings.importing.constants import FETCHING


class SourceFile(Strict):
    """One file of a source: where it stands in the repository, and what it must be."""

    path: str = Field(pattern=r"^[^/\\].*$")
    sha256: Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")]
    bytes: int = Field(gt=0)

    @property
    def name(self) -> str:
        """The file's name without its folders."""
        return self.path.rsplit("/", 1)[-1]


class Source(Strict):
    """source.yaml: a public set of recordings. ``not_importable`` says why a set has no files to fetch."""

    title: str
    repository: str = Field(pattern=r"^[\w.-]+/[\w.-]+/[\w.-]+$", description="host/owner/name")
    commit: str = Field(pattern=r"^[0-9a-f]{40}$")
    licence: str
    cite: str = ""
    not_importable: str = ""
    files: tuple[SourceFile, ...] = ()


def load_source(path: Path | str) -> Source:
    """Read source.yaml. Raises InputError: a key or value that can't be, or neither files nor a reason for having
    none."""
    source = load(Source, path)
    if bool(source.files) == bool(source.not_importable):
        rule = "a source has `files`, or says in `not_importable` why it has none"
        raise InputError(path, "files", f"{len(source.files)} files", rule)
    for number, file in enumerate(source.files):
        parts = PurePosixPath(file.path).parts
        if file.path.startswith("/") or ".." in parts or not parts or "\\" in file.path or "\0" in file.path:
            rule = "a path within the repository: relative, with forward slashes, without `..`"
            raise InputError(path, f"files[{number}].path", file.path, rule)
    names = [file.name for file in source.files]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InputError(path, "files", twice, "files that are fetched into one folder have different names")
    return source


def url_of(source: Source, file: SourceFile, server: str | None = None) -> str:
    """The address of one file as it was at the source's commit.

    Args:
        source, file: what to fetch.
        server: stands in for the repository's host, e.g. "http://127.0.0.1:8000"; None takes https and that host.

    Returns:
        The address.
    """
    host, owner, name = source.repository.split("/")
    start = server.rstrip("/") if server else f"https://{host}"
    return f"{start}/{owner}/{name}/raw/{source.commit}/{urllib.parse.quote(file.path)}"


@dataclass(frozen=True)
class Fetched:
    """What fetching a source did: the files in place, and how each came there ("kept", "copied", "downloaded")."""

    paths: tuple[Path, ...]
    how: tuple[str, ...]

    def text(self) -> str:
        """The report in words."""
        return "\n".join(
            f"{path.name}: {how}, sha256 as stated" for path, how in zip(self.paths, self.how, strict=True)
        )


def fetch_recordings(
    source_file: Path | str, folder: Path | str, recordings_dir: Path | str | None = None, server: str | None = None
) -> Fetched:
    """Bring the raw files of a source into ``folder``, each with the stated sha256.

    A file that is in place with the right checksum is kept. One with a wrong checksum, found in place or just
    downloaded, is kept aside as "<name>.wrong-sha256" and named in the error; nothing half-written is ever left.

    Args:
        source_file: source.yaml; the name of its folder is the name of the set.
        folder: where the raw files go.
        recordings_dir: a local folder that stands in for the network; the files are looked for in its subfolder of
            the set's name (by their path, or by their name there or under raw/, where they may be gzipped).
        server: stands in for the repository's host, see `url_of`.

    Returns:
        The files' paths, and where each came from.

    Raises:
        InputError: no such file, no network, a wrong checksum, or a set that can't be imported.
    """
    source = load_source(source_file)
    if source.not_importable:
        raise InputError(source_file, "not_importable", source.title, source.not_importable)
    stand_in = None if recordings_dir is None else Path(recordings_dir) / Path(source_file).resolve().parent.name
    paths, how = [], []
    for file in source.files:
        target = Path(folder) / file.name
        paths.append(target)
        if target.exists() and digest_of(target) == file.sha256:
            how.append("kept")
            continue
        if target.exists():
            _set_aside(target, target)
        if stand_in is not None:
            _copy(stand_in, file, target)
            how.append("copied")
        else:
            _download(url_of(source, file, server), file, target)
            how.append("downloaded")
    return Fetched(tuple(paths), tuple(how))


def _set_aside(path: Path, target: Path) -> Path:
    aside = target.with_name(target.name + ".wrong-sha256")
    path.replace(aside)
    return aside


def _copy(stand_in: Path, file: SourceFile, target: Path) -> None:
    places = (file.path, f"raw/{file.name}", f"raw/{file.name}.gz", file.name)
    looked = [stand_in / place for place in places]
    found = next((path for path in looked if path.is_file()), None)
    if found is None:
        cure = "Looked for " + ", ".join(str(path) for path in looked) + "."
        raise InputError(stand_in, file.name, "no such file", "recordings_dir must hold every file of the set", cure)
    with replacing(target, at_once=True) as beside:
        packed = found.suffix == ".gz" and not file.name.endswith(".gz")
        with gzip.open(found) if packed else found.open("rb") as stream, beside.open("wb") as copy:
            shutil.copyfileobj(stream, copy)
        actual = digest_of(beside)
        if actual != file.sha256:
            rule = f"its sha256 must be {file.sha256}"
            raise InputError(found, "sha256", actual, rule, "It was left where it is and not used.")


def _download(url: str, file: SourceFile, target: Path) -> None:
    with replacing(target, at_once=True) as beside:
        _receive(url, file, beside)
        actual = digest_of(beside)
        if actual != file.sha256:
            aside = _set_aside(beside, target)
            cure = f"What came was kept aside as {aside}. Fetch again; if it stays so, the source has changed."
            raise InputError(url, "sha256", actual, f"it must be {file.sha256}", cure)


def _receive(url: str, file: SourceFile, path: Path) -> None:
    cure = "Is there a network? A local folder can stand in for it: recordings_dir."
    try:
        with urllib.request.urlopen(url, timeout=FETCHING.timeout_s) as answer, path.open("wb") as stream:
            received = 0
            while block := answer.read(FETCHING.block):
                received += len(block)
                if received > FETCHING.too_large * file.bytes + FETCHING.block:
                    rule = f"the file has {file.bytes} bytes"
                    raise InputError(url, "", f"more than {received} bytes", rule, "Nothing of it was kept.")
                stream.write(block)
    except urllib.error.HTTPError as error:
        found = f"HTTP {error.code} {error.reason}"
        raise InputError(url, "", found, "the file must be at its address", "Has the repository moved?") from error
    except (OSError, HTTPException) as error:
        raise InputError(url, "", f"no answer ({error})", "the file must be fetched", cure) from error
