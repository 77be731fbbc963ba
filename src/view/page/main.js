// The page: a socket to the session, two panes, tools, a panel. Everything that changes the atlas is a line of the session's
// script; this page keeps no state of its own but where it looks from.
import { Pane } from "./panes.js";
import { makeTools } from "./tools.js";
import { Panel } from "./panel.js";

const token = new URLSearchParams(location.search).get("token") || "";
const socket = new WebSocket(`ws://${location.host}/session?token=${encodeURIComponent(token)}`);
socket.binaryType = "arraybuffer";

const app = {
  state: null,
  panes: {},
  send(message) { if (socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message)); },
  act(line) { app.send({ t: "do", line }); },
  undo() { app.act({ do: "undo" }); },
  redo() { app.act({ do: "redo" }); },
  arc(at) { return new Promise(resolve => { app.arcs.push(resolve); app.send({ t: "arc", at }); }); },
  arcs: [],
  save(overlap) { app.send({ t: "save", overlap: !!overlap }); },
};
window.seamlab = app; // for those who drive the page by script

const panel = new Panel(app);
app.panel = panel;
for (const name of ["3d", "uv"]) app.panes[name] = new Pane(app, name, document.getElementById(`pane-${name}`));
const tools = makeTools(app);
app.tools = tools;

const received = {
  state(message) {
    app.state = message;
    panel.show(message);
    for (const pane of Object.values(app.panes)) pane.paint();
  },
  at(message) { app.panes[message.pane].answered(message); },
  arc(message) { const resolve = app.arcs.shift(); if (resolve) resolve(message); },
  refused(message) { panel.say(message.why, true); },
  said(message) { panel.said(message.text); },
  progress(message) { panel.progress(message.stage, message.fraction); },
};

socket.addEventListener("message", event => {
  if (typeof event.data === "string") {
    const message = JSON.parse(event.data);
    if (message.t !== "progress" && message.t !== "at") panel.done();
    if (received[message.t]) received[message.t](message);
    return;
  }
  const bytes = new Uint8Array(event.data), length = bytes[0] + 256 * bytes[1];
  const head = JSON.parse(new TextDecoder().decode(bytes.subarray(2, 2 + length)));
  app.panes[head.pane].frame(head, new Blob([bytes.subarray(2 + length)], { type: head.type }));
});
socket.addEventListener("open", () => { for (const pane of Object.values(app.panes)) pane.look(); });
socket.addEventListener("close", () => panel.say("The session has ended. Start seamlab view again and open its address.", true));

document.getElementById("shown").addEventListener("change", event => app.send({ t: "show", what: event.target.value }));
document.getElementById("undo").addEventListener("click", app.undo);
document.getElementById("redo").addEventListener("click", app.redo);
document.getElementById("pack").addEventListener("click", () => app.act({ do: "pack" }));
document.getElementById("save").addEventListener("click", event => app.save(event.shiftKey));
document.getElementById("stop").addEventListener("click", () => app.send({ t: "stop" }));
document.getElementById("help").addEventListener("click", () => panel.help(tools.list));

document.addEventListener("keydown", event => {
  if (event.target.closest("dialog, select, input")) return;
  const key = event.key.toLowerCase(), control = event.ctrlKey || event.metaKey;
  const done = (() => {
    if (control && key === "z") { (event.shiftKey ? app.redo : app.undo)(); return true; }
    if (control && key === "y") { app.redo(); return true; }
    if (control && key === "s") { app.save(event.shiftKey); return true; }
    if (control && key === "p") { app.act({ do: "pack" }); return true; }
    if (control || event.altKey) return false;
    if (event.key === "?") { panel.help(tools.list); return true; }
    return tools.key(event);
  })();
  if (done) event.preventDefault();
});
