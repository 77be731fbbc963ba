// What the session says of itself: actions, constraints, numbers, messages.
const element = id => document.getElementById(id);

// A line of the script in a few words.
function words(line) {
  const a = JSON.parse(line), short = { ...a };
  delete short.do;
  const rest = Object.entries(short).map(([key, value]) => `${key} ${typeof value === "number" ? +value.toFixed(3) : JSON.stringify(value)}`).join(", ");
  return rest ? `${a.do}: ${rest}` : a.do;
}

export class Panel {
  constructor(app) { this.app = app; }
  show(state) {
    this.history(state);
    this.constraints(state);
    this.facts(state);
    element("undo").disabled = state.cursor === 0;
    element("redo").disabled = state.cursor === state.history.length;
    element("shown").querySelector("[value=texture]").disabled = !state.texture;
    element("save").disabled = !state.can_save;
    element("save").title = state.can_save ? "Save (Ctrl+S); with Shift also while charts overlap" : "Start with -o OUT to save";
    if (state.notes.length) this.say(state.notes.join("; "));
  }
  history(state) {
    const list = element("history");
    list.replaceChildren();
    ["start", ...state.history.map(words)].forEach((text, step) => {
      const item = document.createElement("li"), button = document.createElement("button");
      item.className = step > state.cursor ? "undone" : step === state.cursor ? "now" : "";
      button.textContent = text;
      button.title = text;
      button.addEventListener("click", () => this.app.send({ t: "goto", step }));
      item.append(button);
      list.append(item);
    });
    const now = list.querySelector(".now");
    if (now) now.scrollIntoView({ block: "nearest" });
  }
  constraints(state) {
    const list = element("constraints");
    list.replaceChildren();
    for (const c of state.constraints) {
      const item = document.createElement("li"), text = document.createElement("span"), button = document.createElement("button");
      text.textContent = c.kind === "angle" ? `angle ${c.degrees.toFixed(1)}\u00b0` : c.kind;
      button.textContent = "Drop";
      button.setAttribute("aria-label", `Drop ${text.textContent}`);
      button.addEventListener("click", () => this.app.act({ do: "drop", constraint: c.id }));
      item.append(text, button);
      list.append(item);
    }
    if (!state.constraints.length) list.append(Object.assign(document.createElement("li"), { textContent: "none", className: "quiet" }));
  }
  facts(state) {
    const worst = Math.max(1, ...state.charts.map(c => c.l2 ?? 1));
    const rows = [["charts", state.charts.length], ["facets", state.facets], ["overlapping facets", state.red, state.red > 0],
      ["worst stretch", worst.toFixed(3)], ["revision", state.revision]];
    const list = element("facts");
    list.replaceChildren();
    for (const [name, value, bad] of rows) {
      const dd = document.createElement("dd");
      dd.textContent = value;
      if (bad) dd.className = "bad";
      list.append(Object.assign(document.createElement("dt"), { textContent: name }), dd);
    }
  }
  hover(hit) {
    element("hover").textContent = hit.facet < 0 ? "" :
      `facet ${hit.facet} \u00b7 vertex ${hit.corner[0]}${hit.angle !== null ? ` (${hit.angle.toFixed(1)}\u00b0)` : ""} \u00b7 edge ${hit.side[0]}\u2013${hit.side[1]}${hit.seam ? ", seam" : ""} \u00b7 chart of ${hit.facets}, L2 ${hit.l2 === null ? "-" : hit.l2.toFixed(3)}`;
  }
  say(text, bad = false) { element("message").textContent = text; element("message").className = bad ? "bad" : ""; }
  said(text) { if (!this.titled) { this.titled = true; element("title").textContent = text; document.title = `${text} - seamlab`; } else this.say(text); }
  progress(stage, fraction) { element("progress").hidden = false; element("stage").textContent = stage; element("progress").querySelector("progress").value = fraction; }
  done() { element("progress").hidden = true; }
  help(list) {
    const box = element("keylist");
    box.replaceChildren();
    const row = (key, text) => { const p = document.createElement("p"), k = document.createElement("kbd"); k.textContent = key; p.append(k, ` ${text}`); box.append(p); };
    for (const tool of list) row(tool.key === " " ? "Space" : tool.key.toUpperCase(), `${tool.label}: ${tool.hint}`);
    for (const [key, text] of [["Ctrl+Z", "undo"], ["Ctrl+Shift+Z", "redo"], ["Ctrl+P", "pack"], ["Ctrl+S", "save"], ["Tab", "the other pane"], ["Arrows", "turn, or shift in UV"],
      ["Shift+Arrows", "move the cross; Enter clicks there"], ["+ -", "zoom"], ["Home", "see all"], ["Esc", "let go"]]) row(key, text);
    element("keys").showModal();
  }
}
