#!/usr/bin/python3
"""Opens the pages of `mpmfast report` in a headless browser, as a user would, with the network off.

usage: browse_report.py MPMFAST SOURCE_DIR [SCREENSHOTS]    exit 77 where Chromium, Selenium or VTK is missing
"""
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
import report_browser
from report_browser import SETTLED, check, check_hover, choose, open_page, picture_of, pixels, quiet, run, start_browser
from report_scenes import AXIS, FAILING, OUTFLOW, PLANE, SPACE
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select, WebDriverWait


def check_view(browser, name, canvas, other_field):
    """The particles are there, and change with the frame, the field, the zoom and the play button."""
    check(browser.execute_script("return player.frame > 0"), f"{name}: the page begins with the first frame")
    browser.execute_script("player.go(player.frames.times.length - 1)")
    first = pixels(browser, canvas)
    check(first[0] > 10, f"{name}: the particles are blank ({first[0]} colours)")
    browser.find_element(By.ID, "play").click()
    WebDriverWait(browser, 30).until(lambda b: b.execute_script("return player.frame > 0 && player.frame < player.frames.times.length - 1"))
    browser.execute_script("player.stop()")
    played = pixels(browser, canvas)
    check(played[1] != first[1], f"{name}: play does not change the picture")
    choose(browser, other_field)
    check(pixels(browser, canvas)[1] != played[1], f"{name}: another field does not change the picture")
    check(pixels(browser, "#key canvas")[0] > 30, f"{name}: the colour bar is blank")
    before = pixels(browser, canvas)[1]
    Select(browser.find_element(By.ID, "range")).select_by_value("frame")
    check(pixels(browser, canvas)[1] != before, f"{name}: the range of the frame does not change the picture")
    before = pixels(browser, canvas)[1]
    browser.execute_script("document.querySelector(arguments[0]).dispatchEvent(new WheelEvent('wheel', "
                           "{deltaY: -300, clientX: 400, clientY: 400, cancelable: true}))", canvas)
    check(pixels(browser, canvas)[1] != before, f"{name}: the wheel does not zoom")
    zoomed = pixels(browser, canvas)[1]
    ActionChains(browser).drag_and_drop_by_offset(browser.find_element(By.CSS_SELECTOR, canvas), 60, 25).perform()
    check(pixels(browser, canvas)[1] != zoomed, f"{name}: dragging does not move the picture")
    browser.find_element(By.ID, "fit").click()
    check(pixels(browser, canvas)[1] == before, f"{name}: 'Fit all' does not show all again")
    choose(browser, "body")
    check("left" in browser.find_element(By.ID, "key").text, f"{name}: the bodies are not named")
    browser.execute_script("player.go(0)")
    before = pixels(browser, canvas)[1]
    browser.execute_script("player.go(player.frames.times.length - 1)")
    check(pixels(browser, canvas)[1] != before, f"{name}: the particles do not move from frame to frame")


# Bodies that some pixel shows, or a particle that is not hidden.
SEEN = """
const {view, frames} = player, particles = view.picked ? [...new Set(view.picked)].filter(k => k >= 0)
  : [...view.colours.keys()].filter(k => view.colours[k] !== 0);
return [...new Set(particles.map(k => frames.bodies[k]))].sort();
"""


def check_bodies(browser, name, canvas):
    """A click hides a body and shows it again, a double click shows it alone."""
    before, button = pixels(browser, canvas)[1], browser.find_element(By.CSS_SELECTOR, "#bodies button")
    check(browser.execute_script(SEEN) == [0, 1], f"{name}: not both bodies are shown at first")
    button.click()
    pixels(browser, canvas)
    check(browser.execute_script(SEEN) == [1], f"{name}: a click does not hide a body")
    button.click()
    check(pixels(browser, canvas)[1] == before, f"{name}: a second click does not show the body again")
    for seen in ([0], [0, 1]):
        ActionChains(browser).double_click(button).perform()
        pixels(browser, canvas)
        check(browser.execute_script(SEEN) == seen, f"{name}: after a double click, bodies {browser.execute_script(SEEN)}")


def check_key(browser, name):
    """Outliers are left out until a click takes them in; of one value there is no bar."""
    choose(browser, "von_mises")
    Select(browser.find_element(By.ID, "range")).select_by_value("all")
    width = "return player.scale.upper - player.scale.lower"
    most = browser.execute_script(width)
    check("1 to 99 %" in browser.find_element(By.ID, "key").text, f"{name}: that outliers are left out is not said")
    browser.find_element(By.ID, "outliers").click()
    check(browser.execute_script(width) > most, f"{name}: outliers are not taken in")
    check("all values" in browser.find_element(By.ID, "key").text, f"{name}: that all values are shown is not said")
    browser.find_element(By.ID, "outliers").click()
    check(browser.execute_script(width) == most, f"{name}: outliers are not left out again")
    Select(browser.find_element(By.ID, "range")).select_by_value("frame")
    browser.execute_script("player.go(0)")
    check("0 Pa in this frame" in browser.find_element(By.ID, "key").text, f"{name}: the one value of a field is not said")
    check(not browser.find_elements(By.CSS_SELECTOR, "#key canvas"), f"{name}: a bar of one value")
    text = browser.find_element(By.ID, "particles").text
    check(" mm" in text and "\u00b5m" not in text, f"{name}: lengths are not all in mm")


# How many pixels of a canvas have the colour of its first curve.
CURVE = """
const canvas = document.querySelector(arguments[0]), data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
const [red, green, blue] = rgb(parseInt(CURVES[0].slice(1), 16));
let count = 0;
for (let i = 0; i < data.length; i += 4) count += Math.abs(data[i] - red) + Math.abs(data[i + 1] - green) + Math.abs(data[i + 2] - blue) < 24;
return count;
"""


def check_charts(browser, name, energy):
    """@param energy  how the lines of the tip end: of a plane J are those of a metre"""
    for chart in ["#histories .chart canvas", "#energy .chart canvas"]:
        browser.execute_async_script(SETTLED)
        check(browser.execute_script(CURVE, chart) > 100, f"{name}: {chart} has no curve")
    chart = "#histories .chart canvas"
    before = pixels(browser, chart)[1]
    browser.find_element(By.CSS_SELECTOR, "#histories .legend button").click()
    check(pixels(browser, chart)[1] != before, f"{name}: the legend does not switch a curve off")
    canvas = browser.find_element(By.CSS_SELECTOR, chart)
    ActionChains(browser).move_to_element(canvas).perform()
    tip = browser.find_element(By.CSS_SELECTOR, "#histories .tip")
    check(tip.is_displayed() and re.search(f" [kµm]?{energy}$", tip.text, flags=re.M), f"{name}: hovering over a chart shows '{tip.text}'")
    before = pixels(browser, chart)[1]
    browser.find_element(By.ID, "choose").click()
    browser.find_element(By.CSS_SELECTOR, "#histories .chooser input[value='left.mass_kg']").click()
    check(pixels(browser, chart)[1] != before, f"{name}: choosing a column does not draw it")


def check_words(browser, folder):
    run_json = json.loads((folder / "run.json").read_text())
    text = browser.find_element(By.TAG_NAME, "body").text
    for word in [f"{run_json['particles']:,} particles", run_json["cpu"], run_json["checksum"], "Energy balance"]:
        check(word in text, f"{folder.name}: '{word}' is missing")
    rows = browser.find_elements(By.CSS_SELECTOR, "#passes tr")
    ran = [name for name, seconds in run_json["seconds"].items() if seconds > 0]
    check([row.text.split("\n")[0].startswith(name.replace("_", " ")) for row, name in zip(rows, ran)].count(True) == len(rows) == len(ran),
          f"{folder.name}: the passes that ran are {ran}, {len(rows)} are shown")
    check(len(ran) < len(run_json["seconds"]), f"{folder.name}: no pass of this scene is left out")
    error = browser.execute_script("return readHistory().then(h => energyBalance(h).at(-1))")
    check(abs(error - run_json["energy_error"]) < 1e-6, f"{folder.name}: an energy error of {error}, not {run_json['energy_error']}")
    browser.find_element(By.CSS_SELECTOR, "#scene summary").click()
    check((folder / "scene.yaml").read_text().strip() == browser.execute_script("return document.querySelector('#scene pre').textContent").strip(),
          f"{folder.name}: the scene is not the one that was run")


LIMITED = """
const {frames} = player, edges = [...arguments[1]], before = frames.follows_shape;
frames.follows_shape = arguments[0];
frames.limit(edges, 2, 3);
frames.follows_shape = before;
return [...edges, frames.largest];
"""


def moments(a, b, c, d):
    """Second moments of a domain with these half-edges, row by row."""
    return a * a + b * b, a * c + b * d, c * c + d * d


def check_limits(browser, name):
    """A domain that is stretched far is drawn as it was seeded. Where domains follow F it is drawn as shape functions take it:
    a rectangle along its principal axes, with half-diagonals of nearly a cell and with its own second moments if they fit."""
    long = [50, 0.5, 0, 1]
    check(browser.execute_script(LIMITED, False, long)[:4] == [2, 0, 0, 3], f"{name}: a long domain is not drawn as it was seeded")
    a, b, c, d, largest = browser.execute_script(LIMITED, True, long)
    check(abs(largest - 0.999 * 0.5e-3) < 1e-12, f"{name}: the largest domain is {largest} m")
    for diagonal in [(a + b, c + d), (a - b, c - d)]:
        check(abs(math.hypot(*diagonal) / largest - 1) < 1e-9, f"{name}: a half-diagonal of {diagonal}")
    check(abs(a * b + c * d) < 1e-12 * largest**2, f"{name}: a long domain is no rectangle")
    xx, xy, yy = moments(*long)
    check(abs(math.atan2(c, a) - 0.5 * math.atan2(2 * xy, xx - yy)) < 1e-9, f"{name}: a long domain lies at {math.atan2(c, a)}")
    thin = [0.1 * largest, 0.09 * largest, 0.01 * largest, 0]
    *drawn, _ = browser.execute_script(LIMITED, True, thin)
    check(drawn != thin and abs(drawn[0] * drawn[1] + drawn[2] * drawn[3]) < 1e-12 * largest**2, f"{name}: a thin domain is no rectangle")
    check(all(abs(x - y) < 1e-9 * largest**2 for x, y in zip(moments(*drawn), moments(*thin))), f"{name}: a thin domain has {drawn}")
    short = [0.1 * largest, 0.05 * largest, 0, 0.1 * largest]
    check(browser.execute_script(LIMITED, True, short)[:4] == short, f"{name}: a short domain is not drawn as it is")


def check_plane(browser, program, folder, shots):
    out = run(program, folder, "plane", PLANE)
    open_page(browser, out)
    check(browser.title == "Two <b>blocks</b> & a {{wall}} </script>", f"the title is '{browser.title}'")
    check(browser.find_element(By.ID, "status").text == "finished", "plane: not said to be finished")
    check(browser.execute_script("return player.fieldName") == "von_mises", "plane: the scene's picture is not the first field")
    picture_of(browser, shots, "plane")
    check_view(browser, "plane", "#picture canvas", "velocity_x")
    names = ["left", "right"]
    check_bodies(browser, "plane", "#picture canvas")
    check_key(browser, "plane")
    check_cracks(browser, "plane", "#picture canvas")
    check_limits(browser, "plane")
    check_hover(browser, out, "pressure", 4, lambda arrays: arrays["pressure"], names)
    check_hover(browser, out, "stress_xy", 6, lambda arrays: arrays["stress"][:, 3], names)
    check_charts(browser, "plane", "J/m")
    check_words(browser, out)
    quiet(browser, "plane")


# Is all of the box and its labels in view, and fills it, on a canvas of this size (0: as it is)?
WHOLE = """
const {view} = player, {canvas} = view, [width, height] = arguments;
for (const one of [canvas, view.over]) Object.assign(one.style, width ? {width: width + 'px', height: height + 'px'} : {});
view.fit();
const [left, right, top, bottom] = view.outline(), wide = canvas.clientWidth, high = canvas.clientHeight;
const whole = left >= 0 && top >= 0 && right <= wide && bottom <= high;
const full = right - left > 0.85 * wide || bottom - top > 0.85 * high;
const right_size = !width || wide === width && high === height;
for (const one of [canvas, view.over]) Object.assign(one.style, {width: '', height: ''});
view.fit();
return whole && full && right_size;
"""


def check_space(browser, program, folder, shots):
    out = run(program, folder, "space", SPACE)
    open_page(browser, out)
    if browser.find_elements(By.ID, "no-webgl"):
        print("this browser has no WebGL: the message is there, the view was not tried")
        return
    picture_of(browser, shots, "space")
    for width, height in [(0, 0), (900, 260), (320, 560)]:
        check(browser.execute_script(WHOLE, width, height), f"space: the box and its labels are cut at {width} x {height}")
    check_view(browser, "space", "#picture canvas", "speed")
    check_bodies(browser, "space", "#picture canvas")
    check_key(browser, "space")
    check_hover(browser, out, "velocity_z", 3, lambda arrays: arrays["velocity"][:, 2], ["left", "right"])
    check_charts(browser, "space", "J")
    quiet(browser, "space")


def check_without_webgl(browser, folder):
    """A browser that has no WebGL says so, and shows the rest."""
    script = browser.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source":
        "const before = HTMLCanvasElement.prototype.getContext; HTMLCanvasElement.prototype.getContext = "
        "function (kind, ...rest) { return kind.startsWith('webgl') ? null : before.call(this, kind, ...rest); };"})
    open_page(browser, folder / "space")
    message = browser.find_elements(By.ID, "no-webgl")
    check(message and "WebGL" in message[0].text, "space: nothing is said where there is no WebGL")
    check(pixels(browser, "#histories .chart canvas")[0] > 10, "space: no charts where there is no WebGL")
    notes = browser.find_element(By.CSS_SELECTOR, "#particles .notes").text
    check("Rounded for this page" in notes, "space: notices are lost where there is no WebGL")
    check("Drag" not in notes, "space: dragging is explained where there is nothing to drag")
    browser.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", script)


def check_cracks(browser, name, canvas):
    """The crack of a frame is drawn over its particles, and its stress intensities have a chart."""
    lines = browser.execute_script("return player.frames.linesOf(player.frame)")
    check(len(lines) == 1 and len(lines[0]) > 1, f"{name}: the frame has the lines {lines}")
    before = pixels(browser, canvas)[1]
    browser.execute_script("kept = player.frames.lines; player.frames.lines = undefined; player.go(player.frame)")
    check(pixels(browser, canvas)[1] != before, f"{name}: the crack is not drawn")
    browser.execute_script("player.frames.lines = kept; player.go(player.frame)")
    check(pixels(browser, canvas)[1] == before, f"{name}: the crack is not drawn again")
    browser.find_element(By.XPATH, "//*[@id='histories']//button[text()='stress intensities']").click()
    check(pixels(browser, "#histories .chart canvas")[0] > 10, f"{name}: the chart of stress intensities is blank")
    browser.find_element(By.XPATH, "//*[@id='histories']//button[text()='energies']").click()


def check_failed(browser, program, folder, shots):
    out = run(program, folder, "failing", FAILING, code=3)
    open_page(browser, out)
    reason = json.loads((out / "run.json").read_text())["reason"]
    check(browser.find_element(By.ID, "status").text == "failed", "failing: not said to have failed")
    check(reason and reason in browser.find_element(By.ID, "ending").text, "failing: the reason is missing")
    check(pixels(browser, "#picture canvas")[0] > 3, "failing: the particles are blank")
    check("0 Pa everywhere" in browser.find_element(By.ID, "key").text, "failing: the one value of the field is not said")
    picture_of(browser, shots, "failing")


def check_axis(browser, program, folder, shots):
    out = run(program, folder, "axis", AXIS)
    open_page(browser, out)
    check("axisymmetric" in browser.find_element(By.TAG_NAME, "header").text, "axis: not said to be axisymmetric")
    check(browser.execute_script("return player.fieldName") == "von_mises", "axis: without a picture the first field is not the von Mises stress")
    check(browser.execute_script("return player.frame") < 5, "axis: the ball has left the floor in the frame that is shown first")
    check_bodies(browser, "axis", "#picture canvas")
    check_hover(browser, out, "stress_zz", 3, lambda arrays: arrays["stress"][:, 2], ["ball", "floor"])
    tip = browser.find_element(By.ID, "tip").text
    check(re.search(r"^r ", tip, re.M) and re.search(r"^z ", tip, re.M), f"axis: the tip says '{tip}'")
    browser.find_element(By.XPATH, "//*[@id='histories']//button[text()='stress against strain']").click()
    against = Select(browser.find_element(By.CSS_SELECTOR, "#histories label select")).first_selected_option
    check(against.get_attribute("value") == "top.strain", "axis: stress is not drawn against the strain of the piston")
    check(pixels(browser, "#histories .chart canvas")[0] > 10, "axis: the chart of stress against strain is blank")
    picture_of(browser, shots, "axis")
    quiet(browser, "axis")


def check_outflow(browser, program, folder, shots):
    """Particles that left are gone from the picture, and counted."""
    out = run(program, folder, "outflow", OUTFLOW)
    open_page(browser, out)
    browser.execute_script("player.go(0)")
    pixels(browser, "#picture canvas")
    check(browser.execute_script(SEEN) == [0, 1], "outflow: not both bodies are shown at first")
    browser.execute_script("player.go(player.frames.times.length - 1)")
    pixels(browser, "#picture canvas")
    check(browser.execute_script(SEEN) == [1], "outflow: what left is still shown")
    gone = browser.find_element(By.ID, "figures").text
    check("16 particles" in gone and "kg/m and" in gone and "J/m" in gone, f"outflow: what left is not counted: '{gone}'")
    check_hover(browser, out, "velocity_x", 2, lambda arrays: arrays["velocity"][:, 0], ["missile", "rest"], every=3)
    picture_of(browser, shots, "outflow")
    quiet(browser, "outflow")


def check_stopped(browser, program, folder, shots):
    """A signal ends it in the middle; the page shows the frames until then."""
    out = folder / "stopped"
    (folder / "stopped.yaml").write_text(PLANE.replace("cell: 0.5 mm", "cell: 0.5 mm, leaving: wall")
                                         .replace("end: 60 us", "end: 60 s").replace("frames: 6", "frames: 600000"))
    going = subprocess.Popen([program, "run", folder / "stopped.yaml", "--out", out, "--progress", "none"],
                             stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    begun = time.monotonic()
    while not (out / "particles" / "000002.vtu").exists() and time.monotonic() - begun < 60:
        time.sleep(0.05)
    going.terminate()
    check(going.wait() == 143, "stopped: the signal did not end the run")
    made = subprocess.run([program, "report", out], capture_output=True, text=True)
    check(made.returncode == 0, f"report stopped: exit {made.returncode}: {made.stderr}")
    open_page(browser, out)
    check(browser.find_element(By.ID, "status").text == "stopped", "stopped: not said to be")
    check("mpmfast resume" in browser.find_element(By.ID, "ending").text, "stopped: how to go on is not said")
    check(browser.execute_script("return player.frame === player.frames.times.length - 1 && player.frame > 0"), "stopped: not the last frame is shown")
    check(pixels(browser, "#picture canvas")[0] > 3, "stopped: the particles are blank")
    picture_of(browser, shots, "stopped")
    quiet(browser, "stopped")


def check_bare(browser, program, folder):
    """Without particle files, and while the run goes on."""
    out = run(program, folder, "bare", PLANE, words=["--set", "output.frames=0"])
    open_page(browser, out)
    check("There are no particle files" in browser.find_element(By.ID, "particles").text, "bare: why there is no view is not said")
    check(pixels(browser, "#histories .chart canvas")[0] > 10, "bare: the charts are blank")
    (out / "run.json").unlink()
    history = out / "history.csv"
    history.write_text(history.read_text().splitlines(keepends=True)[0])
    made = subprocess.run([program, "report", out, "--out", out / "report.html", "--force"], capture_output=True, text=True)
    check(made.returncode == 0, f"bare: a run that goes on: exit {made.returncode}: {made.stderr}")
    open_page(browser, out)
    check(browser.find_element(By.ID, "status").text == "not ended", "bare: a run that goes on is not said to")
    check("no row yet" in browser.find_element(By.ID, "histories").text, "bare: a history without rows is not said to be")


def main():
    program, shots = str(pathlib.Path(sys.argv[1]).resolve()), sys.argv[3] if len(sys.argv) > 3 else None
    browser = start_browser()
    try:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            check_plane(browser, program, folder, shots)
            check_space(browser, program, folder, shots)
            check_without_webgl(browser, folder)
            check_failed(browser, program, folder, shots)
            check_axis(browser, program, folder, shots)
            check_outflow(browser, program, folder, shots)
            check_stopped(browser, program, folder, shots)
            check_bare(browser, program, folder)
    finally:
        browser.quit()
    print(f"{report_browser.checks} checks, {len(report_browser.failures)} failed")
    return 1 if report_browser.failures else 0


if __name__ == "__main__":
    sys.exit(main())
