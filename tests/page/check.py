"""The page in a real browser: each tool by real mouse and key events; what was saved, replayed headless, is the same bytes.

    check.py SEAMLAB SEAMLAB-GEN [FOLDER for screenshots]
"""
import os
import signal
import struct
import subprocess
import sys
import tempfile
import time
import zlib

from webdriver import CONTROL, DOWN, ENTER, ESCAPE, LEFT, RIGHT, SHIFT, TAB, Browser

FIND = """
const [pane, what, skip] = arguments, done = arguments[arguments.length - 1];
(async () => {
  const p = seamlab.panes[pane], w = p.picture.width, h = p.picture.height;
  let left = skip;
  const end = performance.now() + 20000;
  for (let k = 0; k < 1500 && performance.now() < end; k++) {
    const x = Math.round(w * (0.1 + 0.8 * ((k * 0.754877666) % 1))), y = Math.round(h * (0.1 + 0.8 * ((k * 0.569840291) % 1)));
    const hit = await p.ask(x, y);
    if (hit.facet < 0) continue;
    const place = what === "seam" ? { xyz: hit.from.xyz.map((v, i) => (v + hit.to.xyz[i]) / 2), uv: hit.from.uv.map((v, i) => (v + hit.to.uv[i]) / 2) } : hit.place;
    const fits = what === "seam" ? hit.seam : what === "border" ? hit.angle !== null : what === "inside" ? hit.angle === null : true;
    if (!fits) continue;
    const at = what === "facet" ? [x, y] : p.project(place);
    if (!at) continue;
    const again = await p.ask(Math.round(at[0]), Math.round(at[1]));
    const same = again.facet >= 0 && (what === "seam" ? again.seam : what === "border" ? again.angle !== null : true);
    if (same && left-- === 0) { const box = p.element.getBoundingClientRect(); done({ x: box.left + 1 + Math.round(at[0]) * p.size[0] / w, y: box.top + 1 + Math.round(at[1]) * p.size[1] / h, hit: again }); return; }
  }
  done(null);
})();
"""


def write_png(path, pixel, size=64):
    """A picture of size x size, pixel(x, y) its colour; whole or not there."""
    rows = b"".join(b"\0" + b"".join(bytes(pixel(x, y)) for x in range(size)) for y in range(size))
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    with open(path + ".part", "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 2, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
    os.rename(path + ".part", path)


class Check:
    def __init__(self, seamlab, generator, pictures):
        self.seamlab, self.pictures, self.failed, self.shots = seamlab, pictures, 0, 0
        self.folder = tempfile.mkdtemp(prefix="seamlab-page-files-")
        subprocess.run([generator, "hand", "-o", self.folder], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.mesh, self.out, self.log = (os.path.join(self.folder, n) for n in ("hand.obj", "out.obj", "log.jsonl"))
        self.texture = os.path.join(self.folder, "paint.png")
        write_png(self.texture, lambda x, y: (230, 40, 30) if (x // 8 + y // 8) % 2 else (250, 200, 60))
        self.server = subprocess.Popen([seamlab, "view", self.mesh, "-o", self.out, "--script", self.log, "--texture",
                                        self.texture, "--quiet"],
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.url = self.server.stdout.readline().strip()
        self.browser = Browser()

    def expect(self, name, true):
        print(("ok      " if true else "FAILED  ") + name)
        self.failed += not true

    def state(self):
        return self.browser.run("return seamlab.state")

    def wait(self, condition, seconds=20):
        end = time.time() + seconds
        while time.time() < end:
            if condition():
                return True
            time.sleep(0.05)
        return False

    def wait_step(self, before):
        return self.wait(lambda: self.state()["cursor"] != before["cursor"] or len(self.state()["history"]) != len(before["history"]))

    def find(self, pane, what, skip=0):
        return self.browser.run_async(FIND, pane, what, skip)

    def click(self, at):
        self.browser.pointer(("move", at["x"], at["y"]), ("down", 0), ("pause", 0.2), ("up", 0))

    def drag(self, a, b):
        steps = [("move", a["x"], a["y"]), ("down", 0), ("pause", 0.4)]
        for k in range(1, 9):
            steps += [("move", a["x"] + (b["x"] - a["x"]) * k / 8, a["y"] + (b["y"] - a["y"]) * k / 8), ("pause", 0.12)]
        self.browser.pointer(*steps, ("pause", 0.4), ("up", 0))

    def shot(self, name):
        if self.pictures:
            time.sleep(0.6)
            self.shots += 1
            self.browser.screenshot(os.path.join(self.pictures, f"{self.shots:02d}-{name}.png"))

    # one tool after another

    def looking(self):
        before = self.browser.run("return [seamlab.panes['3d'].view.azimuth, seamlab.panes['3d'].frames, seamlab.panes.uv.view.zoom]")
        middle = self.browser.run("const b = seamlab.panes['3d'].element.getBoundingClientRect(); return {x: b.left + b.width / 2, y: b.top + b.height / 2}")
        self.drag(middle, {"x": middle["x"] + 120, "y": middle["y"] - 30})
        uv = self.browser.run("const b = seamlab.panes.uv.element.getBoundingClientRect(); return {x: b.left + b.width / 2, y: b.top + b.height / 2}")
        self.browser.wheel(uv["x"], uv["y"], -200)
        self.expect("dragging turns the model", self.wait(lambda: self.browser.run("return seamlab.panes['3d'].view.azimuth") != before[0]))
        self.expect("frames follow", self.wait(lambda: self.browser.run("return seamlab.panes['3d'].frames") > before[1]))
        self.expect("the wheel zooms in UV", self.wait(lambda: self.browser.run("return seamlab.panes.uv.view.zoom") > before[2]))
        self.browser.run("for (const p of Object.values(seamlab.panes)) { p.home(); p.look(); }")
        time.sleep(0.5)
        self.shot("look")

    def one_click(self, key, pane, what, name, grows):
        before = self.state()
        self.browser.keys(key)
        at = self.find(pane, what)
        if at is None:
            self.expect(f"{name}: something to click", False)
            return
        self.click(at)
        self.expect(name, self.wait_step(before))
        now = self.state()
        if grows is not None:
            self.expect(f"{name}: charts {len(before['charts'])} to {len(now['charts'])}", grows(len(before["charts"]), len(now["charts"])))
        self.shot(name.replace(" ", "-"))

    def undo_redo(self):
        before = self.state()
        self.browser.keys(CONTROL, "z")
        self.expect("Ctrl+Z undoes", self.wait(lambda: self.state()["cursor"] == before["cursor"] - 1))
        self.browser.keys(CONTROL, SHIFT, "z")
        self.expect("Ctrl+Shift+Z redoes", self.wait(lambda: self.state()["cursor"] == before["cursor"]))

    def many_clicks(self, key, pane, what, count, name, end=None):
        before = self.state()
        for skip in range(6):
            self.browser.keys(ESCAPE)
            self.browser.keys(key)
            for k in range(count):
                at = self.find(pane, what, skip + 7 * k)
                if at is not None:
                    self.click(at)
                    time.sleep(0.2)
            if end:
                self.browser.keys(end)
            if self.wait_step_short(before):
                break
        self.expect(name, self.state()["cursor"] != before["cursor"])
        self.shot(name.replace(" ", "-"))

    def wait_step_short(self, before):
        return self.wait(lambda: self.state()["cursor"] != before["cursor"], 4)

    def zip(self, key, name):
        before = self.state()
        for skip in range(5):
            self.browser.keys(key)
            a = self.find("3d", "seam", skip)
            if a is None:
                break
            b = {"x": a["x"] + 25, "y": a["y"] + 45}
            self.drag(a, b)
            if self.wait_step_short(before):
                break
        self.expect(name, self.state()["cursor"] != before["cursor"])
        self.shot(name.replace(" ", "-"))

    def angle(self):
        before = self.state()
        for skip in range(6):
            self.browser.keys("a")
            at = self.find("uv", "border", skip)
            self.drag(at, {"x": at["x"] + 40, "y": at["y"]})
            if self.wait_step_short(before):
                break
        self.expect("an angle is dragged", any(c["kind"] == "angle" for c in self.state()["constraints"]))
        self.shot("angle")

    def on_page(self, key, name):
        before = self.state()
        self.browser.keys(key)
        at = self.find("uv", "facet")
        self.drag(at, {"x": at["x"] + 60, "y": at["y"] + 10})
        self.expect(name, self.wait_step(before))
        self.shot(name.replace(" ", "-"))

    def either(self, key, pane, what, count, name, end=None):
        """A tool in a pane: done, or refused in words; never silence."""
        before = self.state()
        self.browser.run("document.getElementById('message').textContent = ''")
        self.browser.keys(ESCAPE)
        self.browser.keys(key)
        for k in range(count):
            at = self.find(pane, what, 2 * k)
            if at is not None:
                self.click(at)
                time.sleep(0.15)
        if end:
            self.browser.keys(end)
        said = lambda: self.browser.run("return document.getElementById('message').textContent")
        answered = self.wait(lambda: self.state()["cursor"] != before["cursor"] or said() != "", 10)
        grew = self.state()["cursor"] > before["cursor"]
        self.expect(f"{name} in {pane}: {'done' if grew else 'refused: ' + said()[:60]}", answered)
        if grew:
            self.browser.keys(CONTROL, "z")
            self.wait(lambda: self.state()["cursor"] == before["cursor"])
        return grew

    def every_tool_in_both_panes(self):
        done = {}
        for pane in ("3d", "uv"):
            for key, what, count, name, end in (
                    ("x", "seam", 1, "delete seam", None), ("k", "inside", 2, "cut", ENTER), ("l", "inside", 1, "loop", None),
                    ("c", "facet", 1, "halve", None), ("m", "facet", 2, "merge", None), ("u", "inside", 1, "unzip", None),
                    ("t", "border", 2, "straighten", ENTER), ("w", "border", 2, "straight border", None),
                    ("b", "border", 4, "rectangle", None), ("o", "border", 1, "right angle", None),
                    ("p", "border", 1, "pin", None), ("h", "border", 2, "share", None), ("y", "facet", 1, "own UVs", None)):
                done[name] = self.either(key, pane, what, count, name, end) or done.get(name, False)
        self.expect("most tools found something to do", sum(done.values()) >= 7)

    def keyboard(self):
        before = self.state()
        self.browser.run("seamlab.panes.uv.element.focus()")
        self.browser.keys("c")
        self.browser.keys(RIGHT)
        self.browser.keys(LEFT)
        at = self.find("uv", "facet")
        self.browser.run("const p = seamlab.panes.uv, b = p.element.getBoundingClientRect(); p.cursor = [Math.round(arguments[0] - b.left - 11), Math.round(arguments[1] - b.top - 1)]", at["x"], at["y"])
        self.browser.keys(SHIFT, RIGHT)
        self.browser.keys(ENTER)
        self.expect("a chart is halved by the keyboard alone", self.wait_step(before))
        self.browser.keys("?")
        self.expect("? lists the keys", self.browser.run("return document.getElementById('keys').open && document.querySelectorAll('#keylist p').length > 20"))
        self.shot("keys")
        self.browser.keys(ESCAPE)

    def steps(self):
        before = self.state()
        self.browser.run("document.querySelectorAll('#history button')[0].click()")
        self.expect("the first line goes to the start", self.wait(lambda: self.state()["cursor"] == 0))
        self.browser.run("const all = document.querySelectorAll('#history button'); all[all.length - 1].click()")
        self.expect("the last line goes back", self.wait(lambda: self.state()["cursor"] == len(before["history"])))

    def shown(self):
        for what in ("stretch", "charts", "plain", "checker"):
            frames = self.browser.run("return seamlab.panes['3d'].frames")
            self.browser.run("const s = document.getElementById('shown'); s.value = arguments[0]; s.dispatchEvent(new Event('change'))", what)
            self.expect(f"{what} is shown", self.wait(lambda: self.browser.run("return seamlab.panes['3d'].frames") > frames))
            if what == "stretch":
                self.shot(what)

    def painted(self):
        mean = """const c = seamlab.panes['3d'].picture, d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
                  let red = 0, green = 0; for (let k = 0; k < d.length; k += 4) { red += d[k] > d[k + 1] + 60; green += d[k + 1] > d[k] + 60; } return [red, green];"""
        self.browser.run("const s = document.getElementById('shown'); s.value = 'texture'; s.dispatchEvent(new Event('change'))")
        self.expect("a texture is shown", self.wait(lambda: self.browser.run(mean)[0] > 5000))
        self.shot("texture")
        write_png(self.texture, lambda x, y: (20, 160 + x, 40))
        self.expect("and seen anew when its file changes", self.wait(lambda: self.browser.run(mean)[1] > 5000))
        self.browser.run("const s = document.getElementById('shown'); s.value = 'checker'; s.dispatchEvent(new Event('change'))")

    def save(self):
        self.browser.keys(CONTROL, "p")
        time.sleep(1.0)
        self.browser.keys(CONTROL, "s")
        said = lambda: self.browser.run("return document.getElementById('message').textContent")
        if self.state()["red"]:
            self.expect("what overlaps is not saved", self.wait(lambda: "overlap" in said()))
            self.browser.keys(CONTROL, SHIFT, "s")
        self.expect("Ctrl+S saves", self.wait(lambda: said().startswith("saved")))
        self.shot("saved")

    def second_page(self):
        other = Browser(1000, 640)
        other.open(self.url)
        same = self.wait(lambda: other.run("return seamlab.state && seamlab.state.revision") == self.state()["revision"])
        self.expect("a second page sees the same session", same)
        if self.pictures:
            time.sleep(0.8)
            other.screenshot(os.path.join(self.pictures, "small.png"))
        other.close()

    def replay(self):
        self.server.send_signal(signal.SIGINT)
        self.server.wait(20)
        again = os.path.join(self.folder, "again.obj")
        done = subprocess.run([self.seamlab, "edit", self.mesh, self.log, "-o", again, "--quiet", "--allow-overlap"], capture_output=True, text=True)
        same = done.returncode == 0 and open(again, "rb").read() == open(self.out, "rb").read()
        self.expect("the session replays headless to the same bytes", same)
        if not same:
            print(done.stderr[-500:])

    def run(self):
        self.browser.open(self.url)
        ready = self.wait(lambda: self.browser.run("return !!(window.seamlab && seamlab.state && seamlab.panes['3d'].frames && seamlab.panes.uv.frames)"))
        self.expect("the page shows the atlas", ready)
        self.looking()
        self.one_click("c", "uv", "facet", "a chart is halved", lambda a, b: b > a)
        self.undo_redo()
        self.one_click("x", "3d", "seam", "a seam is deleted", None)
        self.one_click("l", "3d", "inside", "a loop is cut", None)
        self.browser.keys(CONTROL, "z")
        self.many_clicks("k", "3d", "inside", 2, "a path is cut", ENTER)
        self.browser.keys(CONTROL, "z")
        time.sleep(0.5)
        self.one_click("c", "3d", "facet", "a chart is halved in space", lambda a, b: b > a)
        self.zip("z", "a seam is zipped")
        self.angle()
        self.many_clicks("w", "uv", "border", 2, "a border is straightened")
        self.on_page("g", "a chart is moved")
        self.on_page("r", "a chart is rotated")
        self.on_page("s", "a chart is scaled")
        self.one_click("p", "uv", "border", "a vertex is pinned", None)
        self.every_tool_in_both_panes()
        self.keyboard()
        self.steps()
        self.shown()
        self.painted()
        self.second_page()
        self.save()
        self.browser.close()
        self.replay()
        return self.failed


if __name__ == "__main__":
    check = Check(sys.argv[1], sys.argv[2], sys.argv[3] if len(sys.argv) > 3 else None)
    try:
        failed = check.run()
    finally:
        check.server.kill()
        try:
            check.browser.close()
        except Exception:  # closed already, or past help
            check.browser.driver.kill()
    print(f"{failed} failed")
    sys.exit(failed != 0)
