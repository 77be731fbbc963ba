// The tools. Each makes lines of a session's script; keys are those that Blender's and RizomUV's users know where they have one.
export function makeTools(app) {
  const tools = { picked: [], current: null };
  const need = (hit, what, why) => { if (!what) app.panel.say(why, true); return what; };
  const act = line => app.act(line);
  const clear = () => { tools.picked = []; for (const pane of Object.values(app.panes)) pane.paint(); };

  // A drag that changes one action until it is let go.
  const dragging = { line: null };
  const drag = line => { dragging.line = line; app.send({ t: "drag", line }); };
  const release = () => { if (dragging.line) app.send({ t: "release", line: dragging.line }); dragging.line = null; };
  const letGo = () => { if (dragging.line) app.send({ t: "let-go" }); dragging.line = null; };

  // Collects corners until there are enough, or until Enter or a double click on the last one ends it.
  const collect = (enough, line) => hit => {
    const last = tools.picked[tools.picked.length - 1];
    if (last && last.corner[0] === hit.corner[0]) { if (tools.picked.length > 1) { act(line(tools.picked)); clear(); } return; }
    tools.picked.push(hit);
    if (tools.picked.length === enough) { act(line(tools.picked)); clear(); }
    for (const pane of Object.values(app.panes)) pane.paint();
  };

  // The zipper: a seam is sewn from its end that is nearer to where it was taken, as far as the pointer.
  const nearest = (pane, places, x, y) => {
    let best = 0, least = Infinity;
    places.forEach((place, k) => { const p = pane.project(place), d = p ? Math.hypot(p[0] - x, p[1] - y) : Infinity; if (d < least) { least = d; best = k; } });
    return best;
  };
  const zip = {
    drag: true, arc: null,
    async down(hit) { this.arc = hit.seam ? await app.arc(hit.side) : null; },
    dragged(hit, pane, dx, dy) {
      const arc = this.arc;
      if (!need(hit, hit.seam, "That edge is no seam.") || !arc || arc.vertices.length < 2) return;
      const start = pane.project(hit.place), fromFirst = 2 * arc.edge < arc.vertices.length - 1;
      const k = nearest(pane, arc.places, start[0] + dx, start[1] + dy), to = arc.vertices[k];
      const at = fromFirst ? arc.first : arc.last;
      if (to !== at[0]) drag({ do: "sew", at, to });
    },
    released: release, letGo,
    click(hit) { if (need(hit, hit.seam, "That edge is no seam.")) act({ do: "delete-seam", at: hit.side }); },
  };
  const unzip = {
    drag: "hits",
    start(hit) { const [v, w, f] = hit.side; return hit.corner[0] === w ? [w, v, f] : [v, w, f]; },
    dragged(hit, pane, dx, dy, now) {
      if (!now || now.facet < 0) return;
      const at = this.start(hit);
      if (now.corner[0] !== at[0]) drag({ do: "unsew", at, to: now.corner[0] });
    },
    released: release, letGo,
    click(hit) { act({ do: "unsew", at: this.start(hit), to: this.start(hit)[1] }); },
  };

  // On the page: how far the pointer moved in UV.
  const moved = (pane, dx, dy) => { const s = 1 / (pane.head.h * pane.head.focal); return [dx * s, -dy * s]; };
  const onPage = (hit, pane) => need(hit, pane.name === "uv", "Charts are moved in the UV pane.");

  tools.list = [
    { key: " ", label: "Look", hint: "drag turns, wheel zooms, right drag shifts; Alt + drag does so in every tool" },
    { key: "x", label: "Delete seam", hint: "click a seam: the whole of it is sewn",
      click: hit => need(hit, hit.seam, "That edge is no seam.") && act({ do: "delete-seam", at: hit.side }) },
    { key: "z", label: "Zip", hint: "drag along a seam: it is sewn from where you began to the pointer, and back", ...zip },
    { key: "u", label: "Unzip", hint: "drag along edges or a former seam: it opens as far as the pointer", ...unzip },
    { key: "k", label: "Cut", hint: "click vertices: a seam along the shortest paths between them; Enter, or a click on the last, ends it",
      path: true, click: collect(Infinity, hits => ({ do: "cut-path", vertices: hits.map(h => h.corner[0]) })) },
    { key: "l", label: "Loop", hint: "click an edge: its whole edge loop is cut", click: hit => act({ do: "cut-loop", at: hit.side }) },
    { key: "c", label: "Halve", hint: "click a chart: it is cut in two by an eigenvector", click: hit => act({ do: "cut-chart", facet: hit.facet }) },
    { key: "m", label: "Merge", hint: "click two charts: the longest seam between them is sewn",
      click: collect(2, hits => ({ do: "merge", facets: hits.map(h => h.facet) })) },
    { key: "a", label: "Angle", hint: "drag left or right at a border vertex (yellow): its angle follows",
      drag: true,
      dragged(hit, pane, dx) {
        if (!need(hit, hit.angle !== null, "Only vertices on a chart's border have an angle to turn.")) return;
        drag({ do: "angle", corner: hit.corner, degrees: Math.max(5, Math.min(715, hit.angle + 0.5 * dx)) });
      },
      released: release, letGo,
      click: hit => need(hit, hit.angle !== null, "Only vertices on a chart's border have an angle.") && act({ do: "angle", corner: hit.corner, degrees: Math.round(hit.angle / 45) * 45 }) },
    { key: "t", label: "Straighten", hint: "click neighbouring vertices one after another; Enter, or a click on the last, ends it",
      path: true, click: collect(Infinity, hits => ({ do: "straighten", path: hits.map(h => h.corner) })) },
    { key: "w", label: "Straight border", hint: "click two border vertices: the border between them, chart on its left, is straightened",
      click: collect(2, hits => ({ do: "straighten-border", ends: hits.map(h => h.corner) })) },
    { key: "b", label: "Rectangle", hint: "click four border vertices, in order", click: collect(4, hits => ({ do: "rectangle", corners: hits.map(h => h.corner) })) },
    { key: "o", label: "Right angle", hint: "click where lines or borders meet", click: hit => act({ do: "right", corner: hit.corner }) },
    { key: "p", label: "Pin", hint: "click a vertex: it stays where it is; drag one in UV to pull it",
      drag: true,
      dragged(hit, pane, dx, dy) { if (!onPage(hit, pane)) return; const d = moved(pane, dx, dy); drag({ do: "pin", corner: hit.corner, uv: [hit.place.uv[0] + d[0], hit.place.uv[1] + d[1]] }); },
      released: release, letGo, click: hit => act({ do: "pin", corner: hit.corner, uv: hit.place.uv }) },
    { key: "g", label: "Move", hint: "drag a chart in UV", drag: true,
      dragged(hit, pane, dx, dy) { if (onPage(hit, pane)) drag({ do: "move", facet: hit.facet, by: moved(pane, dx, dy) }); }, released: release, letGo },
    { key: "r", label: "Rotate", hint: "drag a chart in UV left or right", drag: true,
      dragged(hit, pane, dx) { if (onPage(hit, pane)) drag({ do: "rotate", facet: hit.facet, degrees: -0.5 * dx }); }, released: release, letGo },
    { key: "s", label: "Scale", hint: "drag a chart in UV left or right", drag: true,
      dragged(hit, pane, dx) { if (onPage(hit, pane)) drag({ do: "scale", facet: hit.facet, factor: Math.exp(0.005 * dx) }); }, released: release, letGo },
    { key: "h", label: "Share", hint: "click a vertex of a chart, then the one that mirrors it: what corresponds to the chart is cut like it and shares its UVs",
      click: collect(2, hits => ({ do: "symmetry", facet: hits[0].facet, on: true, corners: hits.map(h => h.corner), mirrored: true })) },
    { key: "y", label: "Own UVs", hint: "click a chart that shares by symmetry: it gets UVs of its own", click: hit => act({ do: "symmetry", facet: hit.facet, on: false }) },
  ];

  tools.choose = tool => {
    letGo();
    tools.picked = [];
    tools.current = tool;
    for (const other of tools.list) other.button.setAttribute("aria-pressed", String(other === tool));
    document.getElementById("hint").textContent = tool.hint;
    for (const pane of Object.values(app.panes)) pane.paint();
  };
  tools.key = event => {
    if (event.key === "Escape") { letGo(); tools.picked = []; tools.choose(tools.list[0]); return true; }
    if (event.key === "Enter" && tools.picked.length > 1 && tools.current.path) {
      const last = tools.picked[tools.picked.length - 1];
      tools.current.click(last);
      return true;
    }
    const tool = tools.list.find(entry => entry.key === event.key.toLowerCase());
    if (!tool || event.key === " " && event.target.closest("button")) return false;
    tools.choose(tool);
    return true;
  };
  const bar = document.getElementById("tools");
  for (const tool of tools.list) {
    tool.button = document.createElement("button");
    tool.button.textContent = tool.label;
    tool.button.title = tool.hint;
    const key = document.createElement("kbd");
    key.textContent = tool.key === " " ? "Space" : tool.key.toUpperCase();
    tool.button.append(key);
    tool.button.addEventListener("click", () => tools.choose(tool));
    bar.append(tool.button);
  }
  tools.choose(tools.list[0]);
  return tools;
}
