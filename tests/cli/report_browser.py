"""A headless browser for the pages of `mpmfast report`, and what their checks share."""
import pathlib
import re
import shutil
import subprocess
import sys

MISSING = 77
try:
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.support.ui import Select, WebDriverWait
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(MISSING)

failures = []
checks = 0


def check(holds, what):
    global checks
    checks += 1
    if not holds:
        failures.append(what)
        print(f"FAILED: {what}")


def start_browser():
    """Without a network and a graphics card; nothing where there is no Chromium."""
    chromium, driver = shutil.which("chromium"), shutil.which("chromedriver")
    if not chromium or not driver:
        print("skipped: chromium or chromedriver is missing")
        sys.exit(MISSING)
    options = Options()
    options.binary_location = chromium
    for word in ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-gl=angle",
                 "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--window-size=1280,900"]:
        options.add_argument(word)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    browser = webdriver.Chrome(service=Service(driver), options=options)
    browser.execute_cdp_cmd("Network.enable", {})
    browser.execute_cdp_cmd("Network.emulateNetworkConditions",
                            {"offline": True, "latency": 0, "downloadThroughput": 0, "uploadThroughput": 0})
    return browser


def run(program, folder, name, scene, code=0, words=()):
    (folder / f"{name}.yaml").write_text(scene)
    done = subprocess.run([program, "run", folder / f"{name}.yaml", "--out", folder / name, "--progress", "none",
                           *words], capture_output=True, text=True)
    check(done.returncode == code, f"run {name}: exit {done.returncode}: {done.stderr}")
    made = subprocess.run([program, "report", folder / name], capture_output=True, text=True)
    check(made.returncode == 0, f"report {name}: exit {made.returncode}: {made.stderr}")
    return folder / name


def open_page(browser, folder):
    """Loads the page; what it says on the console, and any other address in it, is a failure."""
    page = folder / "report.html"
    text = re.sub(r'<script type="text/plain".*?</script>', "", page.read_text(), flags=re.S)
    check(not re.search(r'(https?:)?//[\w-]+\.[\w.-]+/|src=|@import|url\(', re.sub(r"^\s*//.*$", "", text, flags=re.M)),
          f"{folder.name}: the page names another address")
    browser.get(page.as_uri())
    try:
        WebDriverWait(browser, 60).until(lambda b: b.execute_script("return document.body.dataset.ready"))
    except Exception:
        check(False, f"{folder.name}: the page was not drawn")
    quiet(browser, folder.name)


def quiet(browser, name):
    for entry in browser.get_log("browser"):
        check(entry["level"] not in ("SEVERE", "ERROR"), f"{name}: console: {entry['message']}")


# Distinct colours of a canvas, and a sum that changes with its pixels.
PIXELS = """
const canvas = document.querySelector(arguments[0]), copy = document.createElement('canvas');
if (!canvas) return [0, 0];
copy.width = canvas.width; copy.height = canvas.height;
const context = copy.getContext('2d');
context.drawImage(canvas, 0, 0);
const data = new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer), colours = new Set(data);
let sum = 0;
for (let i = 0; i < data.length; ++i) sum = (Math.imul(sum, 31) + data[i]) | 0;
return [colours.size, sum];
"""
SETTLED = """
const done = arguments[arguments.length - 1];
requestAnimationFrame(() => requestAnimationFrame(done));
"""


def pixels(browser, selector):
    browser.execute_async_script(SETTLED)
    return browser.execute_script(PIXELS, selector)


def choose(browser, field):
    Select(browser.find_element(By.ID, "field")).select_by_value(field)
    WebDriverWait(browser, 20).until(lambda b: b.execute_script(
        "return player.column ? player.column.name === arguments[0] : ['body', 'material'].includes(arguments[0])", field))


def read_frame(folder, frame):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(folder / "particles" / f"{frame:06}.vtu"))
    reader.Update()
    grid = reader.GetOutput()
    data = grid.GetPointData()
    arrays = {data.GetArrayName(k): vtk_to_numpy(data.GetArray(k)) for k in range(data.GetNumberOfArrays())}
    return vtk_to_numpy(grid.GetPoints().GetData()), arrays


def picture_of(browser, shots, name):
    if shots:
        high = browser.execute_script("window.scrollTo(0, 0); return document.documentElement.scrollHeight")
        browser.set_window_size(1280, high + 140)
        browser.execute_async_script(SETTLED)
        browser.save_screenshot(str(pathlib.Path(shots) / f"{name}.png"))
        browser.set_window_size(1280, 900)


def check_hover(browser, folder, field, frame, values, names, every=20):
    """Every 20th particle (or so) is pointed at through the page; the tip of one is read as a user would."""
    points, arrays = read_frame(folder, frame)
    browser.execute_script("player.stop(); player.go(arguments[0])", frame)
    choose(browser, field)
    rounding = browser.execute_script("return [player.frames.axes[0].rounding(), player.column.rounding()]")
    seen = 0
    for k in range(0, len(points), every):
        shown = browser.execute_script(
            "player.pointer = player.view.find(arguments[0]).slice(0, 2); player.hover(); return player.hovered", k)
        if shown is None:
            continue
        i = shown["particle"]  # in space another one may lie before it
        seen += 1
        check(shown["id"] == arrays["id"][i] and shown["body"] == arrays["body"][i], f"{folder.name}: who particle {i} is")
        check(all(abs(a - b) <= 1.01 * rounding[0] for a, b in zip(shown["place"], points[i])), f"{folder.name}: where particle {i} is")
        check(abs(shown["value"] - values(arrays)[i]) <= 1.01 * rounding[1], f"{folder.name}: {field} of particle {i}: "
              f"{shown['value']}, but {values(arrays)[i]} in the file")
    check(seen > 5, f"{folder.name}: hardly a particle can be pointed at")
    spot = browser.execute_script("const [x, y] = player.view.find(arguments[0]), r = player.picture.getBoundingClientRect();"
                                  "player.picture.scrollIntoView({block: 'center'});"
                                  "return [x - r.width / 2, y - r.height / 2]", len(points) // 3)
    picture = browser.find_element(By.ID, "picture")
    ActionChains(browser).move_to_element_with_offset(picture, round(spot[0]), round(spot[1])).perform()
    tip = browser.find_element(By.ID, "tip")
    check(tip.is_displayed(), f"{folder.name}: no tip at a particle")
    shown = browser.execute_script("return player.hovered")
    check(shown and f"particle {shown['id']}" in tip.text and names[shown["body"]] in tip.text, f"{folder.name}: the tip says '{tip.text}'")
