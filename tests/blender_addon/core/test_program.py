# SPDX-License-Identifier: GPL-3.0-or-later
import core.program
import pytest
from core.errors import AddonError
from core.light_command import LightRequest, light_command, read_report
from core.program import ProgramError, check_program, find_program

GOOD = """
if sys.argv[1:] == ['--version']: print('vmap 0.1.7')
else: print('  --tolerance T   --sky TEXT')
"""


def test_the_program_on_path_is_found(fake_program, monkeypatch, tmp_path):
    path = fake_program(GOOD)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert find_program() == path


def test_version_and_options_are_asked_for(fake_program):
    program = check_program(fake_program(GOOD))
    assert program.version_text() == "0.1.7"
    assert program.light_options == {"--tolerance", "--sky"}


def test_missing_says_what_to_do(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(ProgramError, match="no program .* on PATH.*preferences"):
        check_program()
    with pytest.raises(ProgramError, match="does not exist.*preferences"):
        check_program(str(tmp_path / "absent"))
    with pytest.raises(ProgramError, match="is a folder"):
        check_program(str(tmp_path))


def test_not_executable_says_what_to_do(fake_program, monkeypatch):
    path = fake_program(GOOD)
    monkeypatch.setattr(core.program.os, "access", lambda *_: False)  # root may run anything
    with pytest.raises(ProgramError, match="not executable"):
        check_program(path)


BAD = {
    "another version": ("print('vmap 9.0.0')", "version 9.0.0, this add-on needs 0.1"),
    "another program": ("print('GNU grep 3.8')", "calls itself 'GNU grep 3.8'"),
    "silent": ("", "calls itself ''"),
    "garbage": ("sys.stdout.buffer.write(bytes(range(256)))", "not the vmap program"),
    "failing": ("print('missing library', file=sys.stderr); sys.exit(127)", "failed and said 'missing library'"),
    "crashing": ("os.kill(os.getpid(), signal.SIGSEGV)", "failed"),
    "hanging": ("time.sleep(60)", "did not answer"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_wrong_program_says_what_it_is(fake_program, monkeypatch, name):
    monkeypatch.setattr(core.program, "CHECK_SECONDS", 1)
    body, text = BAD[name]
    with pytest.raises(ProgramError, match=text) as caught:
        check_program(fake_program(body))
    assert str(caught.value).isprintable()


def test_a_file_that_is_no_program_is_refused(write):
    path = write("vmap", b"\x7fnot a program")
    core.program.os.chmod(path, 0o755)
    with pytest.raises(ProgramError, match="cannot be run"):
        check_program(path)


def command(**request):
    program = core.program.Program("vmap", (0, 1, 0), frozenset())
    return light_command(program, "s.glb", ["a.ply", "b.vdb"], "r.json", "p.jsonl", LightRequest(**request))


def test_command_line():
    words = command(tolerance=0.02, points=1000, sky="1,2,3")
    assert words[:7] == ["vmap", "light", "s.glb", "-o", "a.ply", "-o", "b.vdb"]
    assert " ".join(words[7:]) == (
        "--json r.json --progress p.jsonl --light-units compat --tolerance 0.02 --points 1000 --sky 1,2,3"
    )
    assert command(spacing=0.5)[-2:] == ["--spacing", "0.5"]


def test_points_and_spacing_exclude_each_other():
    with pytest.raises(AddonError, match="exclude"):
        command(points=1, spacing=1)


def test_report(write):
    text = '{"points": 7, "seconds": {"total": 1.5}, "error_estimate": {"mean": 0.01}, "warnings": ["a\\u001b"]}'
    report = read_report(write("r.json", text))
    assert (report.points, report.seconds, report.error_mean, report.warnings) == (7, 1.5, 0.01, ["a?"])


@pytest.mark.parametrize("text", ["", "{", "[]", '{"points": 1}', '{"points": "x", "seconds": {"total": 1}}'])
def test_a_broken_report_is_an_error(write, text):
    with pytest.raises(AddonError, match="report"):
        read_report(write("r.json", text))
