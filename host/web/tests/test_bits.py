"""What the page says is what the program says, to the last bit."""

import json
import re
from pathlib import Path

import pytest
from conftest import EXAMPLE, ROOT, line, program, wait_until

DATA = ROOT / "tests/data"
MADE_UP = sorted([EXAMPLE, *DATA.glob("*.csv"), *DATA.glob("fit/*"), *(path for path in DATA.glob("read/*") if path.is_file())])
SHARED = ROOT.parent / "shared"
REAL = sorted([*SHARED.glob("real/*.csv"), *SHARED.glob("formats/*")])


def compare(page, path):
    """Drops one file; returns how many scans of it have the program's fit, or 0 if both refuse it in the same words."""
    page.give(path)
    if not page.text("#json"):
        assert page.error() == program("fit", path.name, "--format", "json", folder=path.parent).strip()
        return 0
    scans = page.page.locator("#scan option").count()
    for scan in range(min(scans, 2)):
        if scan > 0:
            page.page.select_option("#scan", str(scan))
            page.settle()
        wanted = line(page.text("#command"), path.parent)
        assert page.text("#json").encode() == wanted, (path, page.text("#command"))
    return min(scans, 2)


def compare_all(page, paths):
    counts = [compare(page, path) for path in paths]
    print(f"{len(paths)} files: {sum(counts)} fits with the program's bits, {counts.count(0)} files refused in its words")
    assert sum(counts) > len(paths) // 2


def test_made_up_scans(page):
    compare_all(page, MADE_UP)


@pytest.mark.skipif(not REAL, reason="left out: ../shared is not there")
def test_real_scans(page):
    compare_all(page, REAL)


def test_every_option(page):
    page.give(EXAMPLE)
    for option, value in [
        ("mask-retro", "5"), ("max-angle", "78"), ("max-value", "100"), ("thin", "2"), ("sigma-floor", "0.02"), ("forward", "positive"),
        ("quantity", "brdf"), ("value-unit", "plain"), ("angles", "deg"), ("columns", "brdf=3"), ("weights", "equal"), ("drop-invalid", True),
        ("model", "ggx"), ("terms", "diffuse,surface"), ("seed", "7"), ("robust", True), ("precision", "f32"),
    ]:
        page.set(option, value)
        assert page.error() == "", (option, value)
    page.page.evaluate("$('bounds').open = true")
    page.page.get_by_label("largest value of m").fill("0.5")
    page.page.get_by_label("fixed value of n").fill("1.5")
    page.page.get_by_label("fixed value of n").blur()
    page.settle()
    page.set("starts", "60")
    page.set("method", "paper")
    page.click("Fit")
    command = page.text("#command")
    assert "--bounds m=0.00001:0.5 --fix n=1.5" in command or "--bounds m=1e-5:0.5 --fix n=1.5" in command, command
    assert page.text("#json").encode() == line(command, EXAMPLE.parent)


def test_wrong_options_are_refused_in_words(page):
    page.give(EXAMPLE)
    page.set("max-angle", "200")
    assert "Angles beyond" in page.error()
    page.set("max-angle", "")
    page.set("columns", "brdf=9")
    assert page.error() == program("fit", "example.csv", "--columns", "brdf=9", folder=EXAMPLE.parent).strip()


def timeless(contents):
    """A file without the moment at which it was written."""
    return re.sub(rb'"timestamp": "[^"]*"', b"", contents)


def test_results_that_leave(page, tmp_path):
    page.give(EXAMPLE)
    written = tmp_path / "example.json"
    written.write_bytes(page.download("JSON"))
    assert written.read_bytes() == program("fit", "example.csv", "--format", "json", folder=EXAMPLE.parent)
    assert page.download("CSV") == program("fit", "example.csv", "--format", "csv", folder=EXAMPLE.parent)
    assert page.download("Samples as read (CSV)") == program("inspect", "example.csv", "-o", "-", folder=EXAMPLE.parent)
    assert page.download("Report (HTML)") == program("report", "example.csv", folder=EXAMPLE.parent)
    forms = page.page.evaluate("FORMS")
    for form in forms:
        page.page.get_by_label("Form of the export").select_option(form)
        page.page.get_by_label("Wavelength in nm").fill("550")
        wanted = program("export", str(written), "--to", form, "--wavelength", "550", folder=EXAMPLE.parent)
        if isinstance(wanted, str):
            page.click("Export")
            wait_until(page.page, "$('error').textContent !== ''")
            # The program names the file of the result, which the page has not.
            assert page.error().split(": ", 1)[1] == wanted.strip().split(": ", 1)[1], form
            page.page.evaluate("$('error').textContent = ''")
        else:
            assert timeless(page.download("Export")) == timeless(wanted), form
    assert {"zemax", "mitsuba", "openmaterial", "bird"} <= set(forms)


def certify(page, percent, seconds):
    page.page.get_by_label("Part, %").fill(percent)
    page.page.get_by_label("Longest time, s").fill(seconds)
    page.page.get_by_role("button", name="Prove the optimum", exact=True).click()
    page.settle()


def test_further_studies(page):
    page.give(EXAMPLE)
    for button, name in [("Profile", "example-profile-rho_d.json"), ("Compare all models", "example-models.json")]:
        page.click(button)
        wanted = line(page.page.locator("#found pre").nth(1).text_content(), EXAMPLE.parent)
        assert page.download(name) == wanted, name
        assert page.page.locator("#found img").evaluate("image => image.decode().then(() => image.naturalWidth)") > 300
    certify(page, "30", "120")
    assert "\n  proved     within 30 %" in page.text("#found pre.wide")
    wanted = line(page.page.locator("#found pre").nth(1).text_content(), EXAMPLE.parent)
    assert page.download("example-proof.json") == wanted
    page.page.get_by_label("Seeds").fill("1")
    page.click("Error against run time")
    found = json.loads(page.download("example-converge.json"))
    wanted = json.loads(line(page.page.locator("#found pre").nth(1).text_content(), EXAMPLE.parent))
    # Times differ, all else does not.
    for ours, theirs in zip(found["scans"][0]["methods"], wanted["scans"][0]["methods"], strict=True):
        assert ours["by_passes"] == theirs["by_passes"] and ours["elapsed_s"] > 0


def test_marked_samples_are_a_file_of_their_own(page, tmp_path):
    page.give(EXAMPLE)
    page.page.get_by_label("scattering angle from").fill("30")
    page.page.get_by_label("scattering angle to").fill("50")
    page.click("leave out")
    assert page.text("#command") == "brdfit fit example-marked.csv --format json"
    (tmp_path / "example-marked.csv").write_bytes(page.download("Scan without marked samples (CSV)"))
    found = page.text("#json")
    assert json.loads(found)["samples"] == 324 - 4 * 11
    assert found.encode() == line(page.text("#command"), tmp_path)
    page.click("take them back")
    assert json.loads(page.text("#json"))["samples"] == 324


def test_dragging_marks_and_zooms(page):
    page.give(EXAMPLE)
    box = page.page.locator("#canvas").bounding_box()

    def drag():
        page.page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 20)
        page.page.mouse.down()
        page.page.mouse.move(box["x"] + 0.8 * box["width"], box["y"] + 0.6 * box["height"], steps=4)
        page.page.mouse.up()
        page.settle()

    whole = page.page.evaluate("chart.x")
    drag()
    part = page.page.evaluate("chart.x")
    assert part[0] > whole[0] + 20 and part[1] < whole[1]
    page.click("Show all")
    assert page.page.evaluate("chart.x") == whole
    page.click("Mark")
    drag()
    marked = page.page.evaluate("state.marked.size")
    assert 0 < marked < 324
    assert json.loads(page.text("#json"))["samples"] == 324 - marked


def test_several_files(page):
    folder = DATA / "read/f16_one_file_per_theta_i"
    files = sorted(folder.iterdir())
    page.give(*files)
    page.set("one-scan", True)
    if page.error():
        assert page.error() == program("fit", *(path.name for path in files), "--one-scan", folder=folder).strip()
        return
    assert page.text("#json").encode() == line(page.text("#command"), folder)


def test_minima_are_drawn(page):
    page.give(DATA / "testdata1_pos_seed1.csv")
    page.page.get_by_role("button", name="draw 2", exact=True).click()
    wait_until(page.page, "chart.fits.length === 2")
    assert page.page.evaluate("chart.fits.filter(fit => fit.best).length") == 1


def test_all_scans_at_once(page, tmp_path):
    page.give(DATA / "testdata1_pos_seed1.csv", DATA / "testdata2_pos_seed1.csv")
    page.click("Fit all")
    wanted = program("fit", "testdata1_pos_seed1.csv", "testdata2_pos_seed1.csv", "--format", "json", folder=DATA)
    assert page.download("JSON of all") == wanted


def test_an_example_needs_no_file(page):
    page.click("Load an example")
    assert page.text("#json").encode() == program("fit", "example.csv", "--format", "json", folder=Path(EXAMPLE).parent)
