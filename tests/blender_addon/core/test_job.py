# SPDX-License-Identifier: GPL-3.0-or-later
import os
import signal
import time

import pytest
from core.job import Job, JobError, progress_path

REPORT = """
def progress(*lines):
    with open(sys.argv[1], 'a') as f:
        for line in lines: f.write(line + '\\n')
"""


def job_of(program, **options):
    return Job(lambda folder: [program, progress_path(folder)], **options)


def run(program, **options):
    with job_of(program, **options).start() as job:
        job.wait()
        job.check()
        return job


def test_progress_is_read_line_by_line(fake_program):
    body = (
        REPORT
        + """
progress('{"stage": "tree", "fraction": 0.5, "overall": 0.25, "seconds": 1}')
progress('{"stage": "direct", "fraction": 1, "overall": 0.75, "seconds": 2}')
"""
    )
    job = run(fake_program(body))
    assert (job.progress.stage, job.progress.fraction, job.progress.overall) == ("direct", 1, 0.75)


def test_garbage_among_the_progress_is_passed_over(fake_program):
    body = (
        REPORT
        + r"""
progress('{"stage": "tree", "fraction": 0.5}', 'garbage', '[1]', '{"stage": "x", "fraction": 9}', '{"stage": "x"}')
progress('{"stage": "x", "fraction": "NaN"}', '[' * 5000, '\x1b[2J', '{"stage": "cut", "fraction"')
"""
    )
    job = run(fake_program(body))
    assert (job.progress.stage, job.progress.overall) == ("tree", 0.5)


def test_a_line_still_being_written_is_waited_for(fake_program):
    body = """
f = open(sys.argv[1], 'w')
f.write('{"stage": "tree", "frac'); f.flush(); time.sleep(0.3)
f.write('tion": 0.5}\\n'); f.close()
"""
    assert run(fake_program(body)).progress.fraction == 0.5


def test_time_left_is_known_after_a_while(fake_program):
    body = REPORT + 'progress(\'{"stage": "a", "fraction": 0.5}\'); time.sleep(0.2)'
    with job_of(fake_program(body)).start() as job:
        assert job.seconds_left is None
        job.wait()
        assert 0 < job.seconds_left < 5


def test_failure_says_the_error_line_and_keeps_the_last_lines(fake_program):
    body = "print('working', file=sys.stderr); print('vmap: error: room.glb: no light', file=sys.stderr); sys.exit(3)"
    with pytest.raises(JobError, match="code 3: vmap: error: room.glb: no light") as caught:
        run(fake_program(body))
    assert caught.value.lines == ["working", "vmap: error: room.glb: no light"]


def test_failure_without_words_is_said(fake_program):
    with pytest.raises(JobError, match="code 1 and said nothing"):
        run(fake_program("sys.exit(1)"))


def test_a_crash_names_its_signal(fake_program):
    with pytest.raises(JobError, match="SIGSEGV: last words"):
        run(fake_program("print('last words', file=sys.stderr, flush=True); os.kill(os.getpid(), signal.SIGSEGV)"))


def test_being_killed_from_outside_is_reported(fake_program):
    with job_of(fake_program("time.sleep(60)")).start() as job:
        os.kill(job._process.pid, signal.SIGKILL)
        job.wait()
        with pytest.raises(JobError, match="SIGKILL"):
            job.check()


def test_binary_garbage_on_the_log_is_made_printable(fake_program):
    body = "sys.stderr.buffer.write(bytes(range(256)) * 200 + b'\\n\\x1b[2Jend\\n'); sys.exit(1)"
    with pytest.raises(JobError) as caught:
        run(fake_program(body))
    assert caught.value.lines[-1] == "?[2Jend"
    assert all(line.isprintable() and len(line) <= 2000 for line in caught.value.lines)


def test_a_flood_of_log_costs_neither_memory_nor_time(fake_program):
    body = "for i in range(20): sys.stderr.write('x' * 10_000_000)\nsys.stderr.write('\\nthe end\\n'); sys.exit(1)"
    with pytest.raises(JobError, match="the end") as caught:
        run(fake_program(body))
    assert sum(map(len, caught.value.lines)) < 100_000


@pytest.mark.parametrize(
    "body", ["time.sleep(60)", "signal.signal(signal.SIGTERM, signal.SIG_IGN); open('ready', 'w')\ntime.sleep(60)"]
)
def test_cancel_ends_the_program_within_a_second(fake_program, body):
    with job_of(fake_program(body)).start() as job:
        time.sleep(0.3)
        begin = time.monotonic()
        job.cancel()
        job.wait()
        assert time.monotonic() - begin < 1
        with pytest.raises(JobError, match="cancelled"):
            job.check()


def test_cancel_ends_what_the_program_started(fake_program, tmp_path):
    mark = tmp_path / "alive"
    child = f"import time; time.sleep(1.2); open({str(mark)!r}, 'w')"
    body = f"import subprocess; subprocess.Popen([sys.executable, '-c', {child!r}]); time.sleep(60)"
    with job_of(fake_program(body)).start() as job:
        time.sleep(0.4)
        job.cancel()
        job.wait()
    time.sleep(1.2)
    assert not mark.exists()


def test_time_limit_ends_a_program_that_hangs(fake_program):
    with pytest.raises(JobError) as caught:
        run(fake_program("time.sleep(60)"), time_limit=0.3)
    assert "stopped after 0.3 s" in caught.value.lines[-1]


def test_an_exception_while_waiting_ends_the_program(fake_program):
    def interrupt(_):
        raise KeyboardInterrupt

    with job_of(fake_program("time.sleep(60)")).start() as job:
        with pytest.raises(KeyboardInterrupt):
            job.wait(each=interrupt)
        assert job.cancelled and job.poll()


@pytest.mark.parametrize("body", ["", "sys.exit(1)", "time.sleep(60)"])
def test_the_folder_goes_away_whatever_happened(fake_program, body):
    job = job_of(fake_program("open('left', 'w')\n" + body))
    with job.start():
        time.sleep(0.2)
        assert os.path.isdir(job.folder)
    assert not os.path.exists(job.folder)
    assert job.poll()


def test_a_program_that_cannot_start_is_an_error(tmp_path):
    (tmp_path / "vmap").write_text("no program")
    (tmp_path / "vmap").chmod(0o755)
    job = Job(lambda folder: [str(tmp_path / "vmap")])
    with job, pytest.raises(JobError, match="cannot start"):
        job.start()
    assert not os.path.exists(job.folder)


def test_warnings_are_picked_from_the_log(fake_program):
    body = "print('vmap: warning: room.glb: specular is not modelled', file=sys.stderr)"
    assert run(fake_program(body)).warnings() == ["room.glb: specular is not modelled"]
