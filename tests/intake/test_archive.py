"""Zip files as tools and people make them: what comes out, what is left out, and that nothing gets out of bounds."""

import io
import stat
import struct
import tracemalloc
import unicodedata
import zipfile
import zlib
from pathlib import PurePosixPath

import pytest

from autograder.intake.archive import UNICODE_PATH, Archive, Bounds, Refused, contents


def packed(*entries, compression=zipfile.ZIP_DEFLATED):
    """A zip file of (name or ZipInfo, content) pairs."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", compression) as made:
        for name, content in entries:
            made.writestr(name, content)
    return file.getvalue()


def without_flag(name, extra=b"", raw=None):
    """An archive with one entry whose name is in `raw` bytes (default: UTF-8), and which does not say so."""
    raw = raw or name.encode()
    info = zipfile.ZipInfo("x" * len(raw))
    info.extra = extra
    return packed((info, b"1")).replace(b"x" * len(raw), raw)


def test_what_is_in_an_archive_comes_out_in_order(tmp_path):
    made = packed(("b/1.txt", b"one"), ("b/", b""), ("a.txt", b"two"), ("./c/./d.txt", b"three"))
    wanted = {"b/1.txt": b"one", "a.txt": b"two", "c/d.txt": b"three"}
    assert contents(made) == (wanted, [])
    (tmp_path / "made.zip").write_bytes(made)
    assert contents(tmp_path / "made.zip") == (wanted, [])


@pytest.mark.parametrize(
    "name, archive",
    [
        ("Żółć/山田.txt", packed(("Żółć/山田.txt", b"1"))),
        ("Żółć/山田.txt", packed((unicodedata.normalize("NFD", "Żółć/山田.txt"), b"1"))),
        ("Żółć/山田.txt", without_flag("Żółć/山田.txt")),
        ("Müller.txt", without_flag("", raw="Müller.txt".encode("cp437"))),
        ("a/b.txt", packed(("a\\b.txt", b"1"))),
        ("a_b_.txt", packed(("a\nb\u202e.txt", b"1"))),
    ],
    ids=["UTF-8", "accents in two parts", "UTF-8 without the flag", "cp437", "Windows", "control characters"],
)
def test_names_are_read_as_they_were_meant(name, archive):
    assert contents(archive) == ({name: b"1"}, [])


def test_a_name_in_the_extra_field_counts_when_it_is_of_this_entry():
    raw = "Z\xa2.txt".encode("latin-1")
    for checksum, name in ((zlib.crc32(raw), "Zó.txt"), (1, "Zó.txt".encode("cp437").decode("cp437"))):
        field = struct.pack("<BL", 1, checksum) + "Zó.txt".encode()
        extra = struct.pack("<HH", UNICODE_PATH, len(field)) + field
        assert list(contents(without_flag("", extra, raw))[0]) == [name]


NOISE = ["__MACOSX/a/._b.ipynb", "a/._b.ipynb", ".DS_Store", "a/Thumbs.db", ".ipynb_checkpoints/b-checkpoint.ipynb"]


@pytest.mark.parametrize("name", [*NOISE, "a/__pycache__/b.pyc", "desktop.ini", ".git/config"])
def test_what_systems_add_is_passed_over(name):
    assert contents(packed((name, b"1"), ("own.txt", b"2"))) == ({"own.txt": b"2"}, [])


def entry(name, mode):
    info = zipfile.ZipInfo(name)
    info.create_system, info.external_attr = 3, mode << 16
    return info


@pytest.mark.parametrize(
    "name, reason",
    [
        ("../evil.txt", "leads out"),
        ("a/../../evil.txt", "leads out"),
        ("/etc/evil.txt", "leads out"),
        ("\\\\server\\evil.txt", "leads out"),
        ("C:\\evil.txt", "leads out"),
        ("c:evil.txt", "leads out"),
        ("..\\evil.txt", "leads out"),
        ("/".join("a" * 22), "in more than 20 folders"),
        ("é" * 130, "name is too long"),
        (entry("link.txt", stat.S_IFLNK | 0o777), "it is a link"),
        (entry("pipe", stat.S_IFIFO | 0o777), "no regular file"),
        (entry("disk", stat.S_IFBLK | 0o777), "no regular file"),
    ],
)
def test_what_is_no_plain_file_below_the_archive_is_left_out_and_said(name, reason):
    files, problems = contents(packed((name, b"/etc/passwd"), ("own.txt", b"2")))
    assert files == {"own.txt": b"2"}
    assert len(problems) == 1 and reason in problems[0]


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_of_two_entries_of_one_name_the_last_one_counts():
    twice = packed(("ä.txt", b"old"), ("b.txt", b"2"), (unicodedata.normalize("NFD", "ä.txt"), b"new"))
    assert contents(twice) == (
        {"b.txt": b"2", "ä.txt": b"new"}, ["ä.txt: it is in there more than once; the last one was taken."],
    )  # fmt: skip
    assert contents(packed(("a.txt", b"1"), ("A.txt", b"2"))) == ({"a.txt": b"1", "A.txt": b"2"}, [])


def flagged(archive, flag):
    """The archive, whose entries all say so in their general purpose flags."""
    changed = bytearray(archive)
    for signature, offset in ((b"PK\3\4", 6), (b"PK\1\2", 8)):
        start = -1
        while (start := changed.find(signature, start + 1)) >= 0:
            changed[start + offset] |= flag
    return bytes(changed)


def test_encrypted_entries_are_said():
    files, problems = contents(flagged(packed(("own.txt", b"2")), 1))
    assert files == {} and "encrypted; it has to be packed without a password" in problems[0]


def test_a_compression_that_cannot_be_bounded_is_not_read():
    for compression in (zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA):
        files, problems = contents(packed(("own.txt", b"2"), compression=compression))
        assert files == {} and "packed as an ordinary zip file" in problems[0]


def test_a_damaged_entry_costs_itself_alone():
    made = packed(("a.txt", b"first" * 9), ("b.txt", b"second"), compression=zipfile.ZIP_STORED)
    files, problems = contents(made.replace(b"firstfirst", b"firstFirst"))
    assert files == {"b.txt": b"second"} and "a.txt: left out; it is damaged" in problems[0]


@pytest.mark.parametrize("cut", [0, 1, 30, -1, -10, -30])
def test_what_is_no_archive_is_refused(cut):
    with pytest.raises(Refused, match="no zip file, or a damaged one"):
        contents(packed(("a.txt", b"1"), ("b.txt", b"2"))[:cut])


def test_no_byte_that_is_changed_raises_anything_else():
    made = packed(("a/ä.txt", b"first" * 50), ("b.txt", b"second"))
    for position in range(len(made)):
        for value in (0, 255, made[position] ^ 1):
            try:
                contents(made[:position] + bytes([value]) + made[position + 1 :])
            except Refused:
                pass


def test_bombs_are_not_unpacked():
    bomb = packed(("zeros.bin", bytes(15_000_000)), ("own.txt", b"2"))
    lying = bomb.replace(struct.pack("<L", 15_000_000), struct.pack("<L", 900_000))
    tracemalloc.start()
    for archive, reason in ((bomb, "15 MB packed into"), (lying, "damaged")):
        files, problems = contents(archive, Bounds(one=1_000_000))
        assert files == {"own.txt": b"2"} and reason in problems[0]
    assert tracemalloc.get_traced_memory()[1] < 8_000_000
    tracemalloc.stop()


def test_one_and_all_are_bounded():
    many = [(f"{i}.txt", bytes(range(256)) * 4) for i in range(6)]
    files, problems = contents(packed(*many), Bounds(all=4_000))
    assert len(files) == 3 and "at most 0.004 MB of an archive are taken" in problems[0] and len(problems) == 3
    files, problems = contents(packed(*many), Bounds(one=1_000))
    assert not files and "larger than 0.001 MB" in problems[0]
    with pytest.raises(Refused, match="6 files; at most 5"):
        contents(packed(*many), Bounds(entries=5))


def test_a_list_of_millions_is_not_read():
    entries = b"".join(b"PK\1\2" + bytes(24) + b"\1\0" + bytes(16) + b"a" for _ in range(200_000))
    end = b"PK\5\6" + bytes(4) + struct.pack("<HHLLH", 65_535, 65_535, len(entries), 0, 0)
    tracemalloc.start()
    with pytest.raises(Refused, match="too many files"):
        contents(entries + end)
    assert tracemalloc.get_traced_memory()[1] < 3 * len(entries)
    tracemalloc.stop()


def test_nothing_is_read_before_it_is_asked_for():
    made = packed(("a.txt", b"1"), ("b.txt", b"2" * 100))
    with Archive(made, Bounds(all=1)) as archive:
        assert list(archive.entries) == [PurePosixPath("a.txt"), PurePosixPath("b.txt")]
        assert archive.read(PurePosixPath("a.txt")) == b"1"
        with pytest.raises(Refused):
            archive.read(PurePosixPath("b.txt"))
