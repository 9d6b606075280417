"""Public files arrive whole and as stated, or are kept aside and named."""

import functools
import gzip
import hashlib
import http.server
import threading
import urllib.parse

import pytest
import yaml

from armscope.core.inputs import InputError
from armscope.recordings.importing.fetching import fetch_recordings, load_source, url_of

CONTENT = b"j1,j2,x,y,z\n0,0,1,2,3\n"
COMMIT = "0123456789abcdef0123456789abcdef01234567"
PATH = "data set/run one.csv"


@pytest.fixture
def source_file(tmp_path):
    folder = tmp_path / "config" / "my-set"
    folder.mkdir(parents=True)
    write_source(folder / "source.yaml")
    return folder / "source.yaml"


def write_source(path, **changes):
    file = {"path": PATH, "sha256": hashlib.sha256(CONTENT).hexdigest(), "bytes": len(CONTENT)}
    source = {"title": "A set", "repository": "example.org/somebody/robots", "commit": COMMIT, "licence": "MIT"}
    path.write_text(yaml.safe_dump({**source, "files": [file], **changes}))


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


@pytest.fixture
def server(tmp_path):
    """A web server of our own that holds the file where the repository's host would."""
    file = tmp_path / "www" / "somebody" / "robots" / "raw" / COMMIT / PATH
    file.parent.mkdir(parents=True)
    file.write_bytes(CONTENT)
    handler = functools.partial(Quiet, directory=tmp_path / "www")
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as running:
        threading.Thread(target=running.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{running.server_port}", file
        running.shutdown()


def test_the_address_follows_from_repository_commit_and_path(source_file):
    source = load_source(source_file)
    assert url_of(source, source.files[0]) == (
        f"https://example.org/somebody/robots/raw/{COMMIT}/{urllib.parse.quote(PATH)}"
    )


def test_a_file_is_downloaded_once_and_kept_afterwards(source_file, server, tmp_path):
    address, _ = server
    fetched = fetch_recordings(source_file, tmp_path / "raw", server=address)
    assert fetched.how == ("downloaded",)
    assert fetched.paths[0].read_bytes() == CONTENT
    again = fetch_recordings(source_file, tmp_path / "raw", server="http://127.0.0.1:9")
    assert again.how == ("kept",)


def test_a_wrong_checksum_is_kept_aside_and_named(source_file, server, tmp_path):
    address, file = server
    file.write_bytes(b"something else")
    with pytest.raises(InputError, match=r"sha256.*kept aside as .*run one\.csv\.wrong-sha256"):
        fetch_recordings(source_file, tmp_path / "raw", server=address)
    assert [path.name for path in (tmp_path / "raw").iterdir()] == ["run one.csv.wrong-sha256"]
    assert (tmp_path / "raw" / "run one.csv.wrong-sha256").read_bytes() == b"something else"


def test_a_damaged_file_in_place_is_set_aside_and_fetched_anew(source_file, server, tmp_path):
    address, _ = server
    (tmp_path / "raw").mkdir()
    (tmp_path / "raw" / "run one.csv").write_bytes(CONTENT[:-4])
    fetched = fetch_recordings(source_file, tmp_path / "raw", server=address)
    assert fetched.paths[0].read_bytes() == CONTENT
    assert (tmp_path / "raw" / "run one.csv.wrong-sha256").read_bytes() == CONTENT[:-4]


def test_endless_or_missing_answers_leave_nothing_behind(source_file, server, tmp_path):
    address, file = server
    file.write_bytes(b"0" * (3 << 20))
    with pytest.raises(InputError, match="bytes"):
        fetch_recordings(source_file, tmp_path / "raw", server=address)
    file.unlink()
    with pytest.raises(InputError, match="HTTP 404"):
        fetch_recordings(source_file, tmp_path / "raw", server=address)
    with pytest.raises(InputError, match="recordings_dir"):
        fetch_recordings(source_file, tmp_path / "raw", server="http://127.0.0.1:9")
    assert list((tmp_path / "raw").iterdir()) == []


@pytest.mark.parametrize("place", [PATH, "raw/run one.csv", "run one.csv"])
def test_a_local_folder_stands_in_for_the_network(place, source_file, tmp_path):
    local = tmp_path / "local" / "my-set" / place
    local.parent.mkdir(parents=True)
    local.write_bytes(CONTENT)
    fetched = fetch_recordings(source_file, tmp_path / "raw", recordings_dir=tmp_path / "local")
    assert fetched.how == ("copied",)
    assert fetched.paths[0].read_bytes() == CONTENT


def test_a_local_copy_may_be_packed(source_file, tmp_path):
    local = tmp_path / "local" / "my-set" / "raw" / "run one.csv.gz"
    local.parent.mkdir(parents=True)
    local.write_bytes(gzip.compress(CONTENT))
    fetched = fetch_recordings(source_file, tmp_path / "raw", recordings_dir=tmp_path / "local")
    assert fetched.paths[0].read_bytes() == CONTENT


def test_a_local_file_that_is_wrong_or_missing_is_named_and_not_used(source_file, tmp_path):
    local = tmp_path / "local" / "my-set"
    local.mkdir(parents=True)
    with pytest.raises(InputError, match="Looked for"):
        fetch_recordings(source_file, tmp_path / "raw", recordings_dir=tmp_path / "local")
    (local / "run one.csv").write_bytes(b"something else")
    with pytest.raises(InputError, match="left where it is"):
        fetch_recordings(source_file, tmp_path / "raw", recordings_dir=tmp_path / "local")
    assert not (tmp_path / "raw").exists() or not list((tmp_path / "raw").iterdir())


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"files": []}, "says in `not_importable`"),
        ({"commit": "main"}, "commit"),
        ({"files": [{"path": "/etc/passwd", "sha256": "0" * 64, "bytes": 1}]}, "path"),
        ({"files": [{"path": f"{d}/a.csv", "sha256": "0" * 64, "bytes": 1} for d in "ab"]}, "different names"),
    ],
)
def test_a_source_that_can_not_be_is_one_clear_error(changes, message, source_file):
    write_source(source_file, **changes)
    with pytest.raises(InputError, match=message):
        load_source(source_file)
