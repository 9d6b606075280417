"""A pipe can be read once: within a command, a copy of it is read as often as needed."""

import io
import os
import threading
from types import SimpleNamespace

from armscope.core.streams import at_hand, is_stream, pipes_kept


def filled(path, content):
    """A thread that writes into a named pipe, once."""
    writer = threading.Thread(target=path.write_bytes, args=(content,))
    writer.start()
    return writer


def test_a_pipe_is_read_once_and_then_as_often_as_one_likes(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with pipes_kept():
        writer = filled(pipe, b"some rows")
        copies = {at_hand(pipe) for _ in range(3)}
        writer.join()
        (copy,) = copies
        assert [copy.read_bytes() for _ in range(2)] == [b"some rows"] * 2
    assert not copy.exists()
    with pipes_kept():
        writer = filled(pipe, b"others")
        assert at_hand(pipe).read_bytes() == b"others"
        writer.join()


def test_a_dash_is_standard_input(monkeypatch):
    monkeypatch.setattr("sys.stdin", SimpleNamespace(buffer=io.BytesIO(b"told")))
    with pipes_kept(), pipes_kept():
        assert is_stream("-")
        assert at_hand("-").read_bytes() == at_hand("-").read_bytes() == b"told"


def test_files_and_what_never_ends_are_left_where_they_are(tmp_path, monkeypatch):
    """Nothing is made for them, either: a command that is killed leaves nothing behind."""
    (tmp_path / "table.csv").write_text("a")
    monkeypatch.setattr("tempfile.tempdir", "/nowhere")
    with pipes_kept():
        for path in (tmp_path / "table.csv", tmp_path / "absent.csv", tmp_path, "/dev/zero"):
            assert str(at_hand(path)) == str(path)
    assert str(at_hand("-")) == "-"
