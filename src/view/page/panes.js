// One pane: a frame from the server, an overlay drawn here, pointer and keys.
const POINTER = "#e8590c", YELLOW = "#f2b705", PATH = "#7048e8";

export class Pane {
  constructor(app, name, element) {
    Object.assign(this, { app, name, element, head: null, hit: null, asked: [], waiting: false, press: null, cursor: null });
    [this.picture, this.over] = element.querySelectorAll("canvas");
    this.home();
    new ResizeObserver(() => this.look()).observe(element);
    element.addEventListener("pointerdown", event => this.down(event));
    element.addEventListener("pointermove", event => this.move(event));
    element.addEventListener("pointerup", event => this.up(event));
    element.addEventListener("pointerleave", () => { if (!this.press) { this.hit = null; this.repaint(); } });
    element.addEventListener("wheel", event => this.wheel(event), { passive: false });
    element.addEventListener("contextmenu", event => event.preventDefault());
    element.addEventListener("keydown", event => this.key(event));
  }
  home() {
    this.view = this.name === "3d" ? { azimuth: 35, elevation: 20, zoom: 1, x: 0, y: 0 } : { zoom: 1, x: 0.5, y: 0.5 };
  }
  get size() { return [Math.max(16, Math.round(this.element.clientWidth)), Math.max(16, Math.round(this.element.clientHeight))]; }
  look(still = false) {
    const [w, h] = this.size;
    this.app.send({ t: "look", pane: this.name, w: Math.min(w, 4096), h: Math.min(h, 4096), ...this.view, still });
  }
  async frame(head, blob) {
    const bitmap = await createImageBitmap(blob);
    this.head = head;
    if (this.picture.width !== head.w || this.picture.height !== head.h) [this.picture.width, this.picture.height] = [head.w, head.h];
    this.picture.getContext("2d").drawImage(bitmap, 0, 0);
    bitmap.close();
    this.frames = (this.frames || 0) + 1;
    this.app.send({ t: "seen", pane: this.name });
    this.paint();
  }
  // A place { xyz, uv } on this pane's picture; null behind the eye.
  project(place) {
    const c = this.head;
    if (!c) return null;
    const point = this.name === "3d" ? place.xyz : [place.uv[0], place.uv[1], 0];
    const d = point.map((v, k) => v - c.eye[k]), dot = a => a[0] * d[0] + a[1] * d[1] + a[2] * d[2];
    const z = dot(c.forward);
    if (c.perspective && z < c.near) return null;
    const s = c.h * c.focal / (c.perspective ? z : 1);
    return [c.w * c.centre[0] + s * dot(c.right), c.h * c.centre[1] - s * dot(c.up)];
  }
  repaint() { for (const pane of Object.values(this.app.panes)) pane.paint(); }
  paint() {
    const canvas = this.over, [w, h] = [this.picture.width, this.picture.height];
    if (canvas.width !== w || canvas.height !== h) [canvas.width, canvas.height] = [w, h];
    const g = canvas.getContext("2d");
    g.clearRect(0, 0, w, h);
    this.constraints(g);
    for (const pane of Object.values(this.app.panes)) if (pane.hit && pane.hit.facet >= 0) this.pointer(g, pane.hit);
    this.picked(g);
    if (this.cursor) { g.strokeStyle = POINTER; g.lineWidth = 1.5; g.beginPath(); g.moveTo(this.cursor[0] - 9, this.cursor[1]); g.lineTo(this.cursor[0] + 9, this.cursor[1]); g.moveTo(this.cursor[0], this.cursor[1] - 9); g.lineTo(this.cursor[0], this.cursor[1] + 9); g.stroke(); }
  }
  dot(g, place, color, radius) {
    const p = this.project(place);
    if (!p) return;
    g.beginPath(); g.arc(p[0], p[1], radius, 0, 2 * Math.PI);
    g.fillStyle = color; g.fill(); g.lineWidth = 1.2; g.strokeStyle = "#222"; g.stroke();
  }
  constraints(g) {
    if (!this.app.state) return;
    for (const c of this.app.state.constraints) {
      const dots = c.kind === "straighten" || c.kind === "straighten-border" ? [c.at[0], c.at[c.at.length - 1]] : c.at;
      for (const place of dots) this.dot(g, place, c.kind === "pin" ? PATH : YELLOW, 5);
    }
  }
  pointer(g, hit) {
    const a = this.project(hit.from), b = this.project(hit.to);
    if (a && b) { g.beginPath(); g.moveTo(...a); g.lineTo(...b); g.lineWidth = 3; g.strokeStyle = POINTER; g.stroke(); }
    this.dot(g, hit.place, hit.border ? YELLOW : "#fff", 3.5);
  }
  picked(g) {
    const places = this.app.tools ? this.app.tools.picked.map(hit => hit.place) : [];
    const points = places.map(place => this.project(place)).filter(Boolean);
    if (points.length > 1) { g.beginPath(); points.forEach((p, k) => k ? g.lineTo(...p) : g.moveTo(...p)); g.lineWidth = 2; g.setLineDash([5, 4]); g.strokeStyle = PATH; g.stroke(); g.setLineDash([]); }
    for (const place of places) this.dot(g, place, PATH, 4.5);
  }
  at(event) {
    const box = this.element.getBoundingClientRect(), [w, h] = this.size;
    return [Math.round((event.clientX - box.left - 1) * this.picture.width / w), Math.round((event.clientY - box.top - 1) * this.picture.height / h)];
  }
  // What is under a pixel; the newest question is the one that is answered.
  ask(x, y) {
    return new Promise(resolve => {
      this.asked.push(resolve);
      this.app.send({ t: "at", pane: this.name, x: Math.max(-1, Math.min(4096, x)), y: Math.max(-1, Math.min(4096, y)) });
    });
  }
  answered(hit) {
    this.hit = hit;
    this.waiting = false;
    for (const resolve of this.asked.splice(0)) resolve(hit);
    this.app.panel.hover(hit);
    this.repaint();
  }
  async down(event) {
    this.element.focus();
    this.element.setPointerCapture(event.pointerId);
    const at = this.at(event), tool = this.app.tools.current;
    const around = event.button === 1 || event.button === 2 || event.altKey || !tool.down && !tool.click && !tool.drag;
    this.press = { at, around, shift: event.shiftKey, button: event.button, moved: false, hit: null };
    if (!around) {
      const press = this.press;
      press.hit = await this.ask(...at);
      if (tool.down && press.hit.facet >= 0 && this.press === press) tool.down(press.hit, this);
    }
  }
  async move(event) {
    const at = this.at(event), press = this.press;
    if (!press) { if (!this.waiting) { this.waiting = true; this.ask(...at); } return; }
    const dx = at[0] - press.at[0], dy = at[1] - press.at[1];
    if (Math.abs(dx) + Math.abs(dy) > 3) press.moved = true;
    if (press.around || !this.app.tools.current.drag) {
      if (press.moved) { this.turn(dx, dy, press.shift || press.button === 2); press.at = at; }
    } else if (press.hit && press.hit.facet >= 0) {
      const tool = this.app.tools.current;
      if (tool.drag === "hits") { if (!this.waiting) { this.waiting = true; tool.dragged(press.hit, this, dx, dy, await this.ask(...at)); } }
      else tool.dragged(press.hit, this, dx, dy, null);
    }
  }
  async up(event) {
    const press = this.press, tool = this.app.tools.current;
    this.press = null;
    if (!press || press.around) { this.look(true); return; }
    const hit = press.hit || await this.ask(...press.at);
    if (press.moved && tool.drag) tool.released(hit, this);
    else if (!press.moved && tool.click && hit.facet >= 0) tool.click(hit, this, event.shiftKey);
    else if (tool.letGo) tool.letGo();
    if (press.moved && !tool.drag) this.look(true);
  }
  turn(dx, dy, pan) {
    const v = this.view, h = this.picture.height || 1;
    if (this.name === "3d" && !pan) {
      v.azimuth -= 0.4 * dx;
      v.elevation = Math.max(-89.9, Math.min(89.9, v.elevation + 0.4 * dy));
    } else if (this.name === "3d") { v.x += 2.2 * dx / h / v.zoom; v.y -= 2.2 * dy / h / v.zoom; }
    else if (this.head) { const scale = 1 / (this.head.h * this.head.focal); v.x -= dx * scale; v.y += dy * scale; }
    this.look();
  }
  wheel(event) {
    event.preventDefault();
    const factor = Math.exp(-0.0015 * event.deltaY), v = this.view;
    if (this.name === "uv" && this.head) {
      const [px, py] = this.at(event), scale = 1 / (this.head.h * this.head.focal);
      const dx = (px - this.head.w / 2) * scale, dy = -(py - this.head.h / 2) * scale;
      v.x += dx * (1 - 1 / factor); v.y += dy * (1 - 1 / factor);
    }
    v.zoom = Math.max(0.05, Math.min(1e4, v.zoom * factor));
    this.look();
  }
  async key(event) {
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const centre = [Math.round(this.picture.width / 2), Math.round(this.picture.height / 2)];
    if (arrows && event.shiftKey) { this.cursor = this.cursor || centre; this.cursor = this.cursor.map((v, k) => v + 10 * arrows[k]); this.ask(...this.cursor); }
    else if (arrows) this.turn(-15 * arrows[0], -15 * arrows[1], event.ctrlKey);
    else if (event.key === "+" || event.key === "=") { this.view.zoom *= 1.25; this.look(); }
    else if (event.key === "-") { this.view.zoom /= 1.25; this.look(); }
    else if (event.key === "Home") { this.home(); this.look(); }
    else if (event.key === "Enter") {
      const hit = await this.ask(...(this.cursor || centre)), tool = this.app.tools.current;
      if (hit.facet >= 0 && tool.click) tool.click(hit, this, event.shiftKey);
    } else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
