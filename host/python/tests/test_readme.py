"""The programs of the README run, and print what it says."""

import re

import pytest

from common import ROOT

README = (ROOT / "host" / "python" / "README.md").read_text()
PROGRAMS = re.findall(
    r"```sh\npython - <<'EOF'\n(.*?)EOF\n```(?:\n\nprints\n\n```text\n(.*?)```)?", README, flags=re.DOTALL
)


@pytest.mark.parametrize("program, printed", PROGRAMS)
def test_a_program_of_the_readme(program, printed, capsys, monkeypatch):
    monkeypatch.chdir(ROOT)
    (ROOT / "target").mkdir(exist_ok=True)
    exec(program, {})
    output = capsys.readouterr().out
    assert output == printed if printed else output


def test_there_are_such_programs():
    assert len(PROGRAMS) == 3 and sum(bool(printed) for _, printed in PROGRAMS) == 2
