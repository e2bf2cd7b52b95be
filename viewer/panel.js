// The panel beside the picture: lists and figures. Text only ever enters as text.
import { INFERRED, SEEN, colorOfId, css, ramp } from "./colors.js";
import { SIGMA_FULL_M } from "./objects.js";

export function element(tag, { text, ...properties } = {}, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  if (text !== undefined) made.textContent = text;
  made.append(...children);
  return made;
}

const $ = (id) => document.getElementById(id);
const mm = (metres) => (1000 * metres).toFixed(metres < 0.01 ? 1 : 0);
const percent = (share) => `${Math.round(100 * share)} %`;

/** Rows of name, bar (share of `full`) and value. */
function bars(rows, full) {
  const grid = element("div", { className: "bars" });
  for (const { name, value, text, color } of rows) {
    const fill = element("i");
    fill.style.width = `${Math.min(100, (100 * value) / full)}%`;
    if (color) fill.style.background = color;
    grid.append(element("span", { text: name }), element("div", {}, fill), element("span", { text }));
  }
  return grid;
}

function figures(pairs) {
  const list = element("dl", { className: "figures" });
  for (const [name, value] of pairs) list.append(element("dt", { text: name }), element("dd", { text: value }));
  return list;
}

const sureness = (object) => object.classProbabilities[object.className] ?? 0;

export function showObjects(scene, selected, onPick) {
  const list = $("objects");
  $("no-objects").hidden = scene.objects.length > 0;
  // The list keeps its items where the objects stay, so that neither focus nor a click gets lost under a finger.
  const items = new Map([...list.children].map((item) => [item.dataset.id, item]));
  scene.objects.forEach((object, place) => {
    const id = String(object.id);
    let item = items.get(id);
    items.delete(id);
    if (!item) {
      item = element("li", { id: `object-${id}` }, element("i"), element("div", {}, element("b"), document.createTextNode(" "), element("small")), element("em"));
      item.setAttribute("role", "option");
      item.dataset.id = id;
      item.addEventListener("click", () => onPick(object.id));
    }
    if (list.children[place] !== item) list.insertBefore(item, list.children[place] ?? null);
    item.setAttribute("aria-selected", object.id === selected);
    item.children[0].style.background = css(colorOfId(object.id));
    item.querySelector("b").textContent = object.className;
    item.querySelector("small").textContent = `#${id} · ${object.grasps.length ? `${object.grasps.length} grasp${object.grasps.length > 1 ? "s" : ""}` : object.noGraspReason.replaceAll("_", " ")}${object.fresh ? "" : " · kept"}`;
    item.querySelector("em").textContent = percent(sureness(object));
  });
  for (const gone of items.values()) gone.remove();
  if (selected === null) list.removeAttribute("aria-activedescendant");
  else list.setAttribute("aria-activedescendant", `object-${selected}`);
}

export function showDetails(object, decoded) {
  const box = $("details");
  box.hidden = !object;
  if (!object) return;
  const classes = Object.entries(object.classProbabilities).sort((a, b) => b[1] - a[1]).slice(0, 5);
  const sigmas = decoded ? [...decoded.sigmas].sort((a, b) => a - b) : [];
  const seen = decoded ? decoded.seen.reduce((sum, one) => sum + one, 0) / Math.max(1, decoded.count) : 0;
  const best = object.grasps[0], evidence = object.evidence;
  const size = [object.extentsM.x, object.extentsM.y, object.extentsM.z].map(mm).join(" × ");
  const pairs = [
    ["Method", object.method], ["Size", `${size} mm`], ["Volume, filled", `${(1000 * object.volumeFilledM3).toFixed(3)} l`], ["Volume, material", `${(1000 * object.volumeMaterialM3).toFixed(3)} l`],
    ["Surface seen", percent(seen)], ["Median sigma", sigmas.length ? `${mm(sigmas[sigmas.length >> 1])} mm` : "–"], ["RMS to the points", `${(1000 * evidence.rmsM).toFixed(1)} mm`],
    ["Silhouette IoU", evidence.silhouetteIou.toFixed(2)], ["Fit similarity", evidence.fitSimilarity.toFixed(2)], ["Mesh", `${object.vertices.count} vertices, ${object.closed ? "closed" : "OPEN"}`],
  ];
  const grasp = best
    ? [["Width", `${mm(best.widthM)} mm`], ["Epsilon", best.epsilon.toFixed(3)], ["P(force closure)", percent(best.pForceClosure)], ["Contacts seen", best.visibility], ["Clearance", `${mm(best.collisionMarginM)} mm`], ["Advice", best.abstain ? "abstain: too uncertain" : "execute"]]
    : [["None", object.noGraspReason.replaceAll("_", " ")]];
  box.replaceChildren(
    element("h2", { text: `${object.className} #${object.id}` }),
    bars(classes.map(([name, p]) => ({ name, value: p, text: percent(p), color: css(colorOfId(object.id)) })), 1),
    element("h2", { text: "Fit" }), figures(pairs),
    element("h2", { text: "Best grasp" }), figures(grasp));
}

const FRAME_BUDGET_MS = 33;

export function showStages(scene, age_ms) {
  const stages = Object.entries(scene.ms).filter(([name]) => name !== "total");
  const total = scene.ms.total ?? stages.reduce((sum, [, ms]) => sum + ms, 0);
  const rows = stages.sort((a, b) => b[1] - a[1]).map(([name, ms]) => ({ name: name.replaceAll("_", " "), value: ms, text: `${ms.toFixed(1)} ms`, color: ms > FRAME_BUDGET_MS ? "var(--inferred)" : undefined }));
  $("stages").replaceChildren(bars(rows, Math.max(FRAME_BUDGET_MS, total)));
  $("total").textContent = `${total.toFixed(0)} ms · ${Math.max(0, age_ms).toFixed(0)} ms old`;
}

export function showSensors(statuses) {
  $("sensors").replaceChildren(
    ...[...statuses.values()].map((status) => {
      const isWell = status.state === "streaming" || status.state === "ended";
      const title = element("div", {}, element("b", { text: status.sensor }), document.createTextNode(" "), element("span", { text: status.state, className: isWell ? "" : "trouble" }));
      const pairs = [
        ["Frames, processed", `${status.fps.toFixed(1)} / ${status.scenesFps.toFixed(1)} per s`], ["Latency p50 / p99", `${status.latencyP50Ms.toFixed(0)} / ${status.latencyP99Ms.toFixed(0)} ms`],
        ["Frames dropped", `${status.framesDropped} of ${status.frames}`],
      ];
      if (status.corruptFrames) pairs.push(["Corrupt frames", String(status.corruptFrames)]);
      if (status.reconnects) pairs.push(["Reconnects", String(status.reconnects)]);
      if (status.lastError) pairs.push(["Last error", status.lastError]);
      return element("div", { className: "sensor" }, title, figures(pairs));
    }));
}

export function showLegend(mode) {
  const swatch = (color, text) => {
    const box = element("i");
    box.style.background = css(color);
    return element("span", {}, box, document.createTextNode(text));
  };
  const legend = $("legend");
  if (mode === "seen") legend.replaceChildren(swatch(SEEN, "seen"), swatch(INFERRED, "inferred"));
  else if (mode === "sigma") {
    const scale = element("span", { className: "ramp" });
    scale.style.background = `linear-gradient(90deg, ${[0, 0.25, 0.5, 0.75, 1].map((t) => css(ramp(t))).join(", ")})`;
    legend.replaceChildren(element("span", { text: "sigma 0" }), scale, element("span", { text: `${mm(SIGMA_FULL_M)} mm` }));
  } else legend.replaceChildren(element("span", { text: "a colour an object" }));
}

export function showConnection(state) {
  const pill = $("connection");
  pill.textContent = { live: "live", restarted: "live", lost: "no connection", connecting: "connecting", paused: "paused" }[state];
  pill.className = `pill ${{ live: "live", restarted: "live", lost: "lost" }[state] ?? ""}`;
  $("notice").textContent = state === "lost" ? "gfpd does not answer. Trying again…" : state === "connecting" ? "Connecting…" : "";
}
