// The panel beside the picture: lists and figures.
import { INFERRED, SECOND_INFERRED, SECOND_SEEN, SEEN, colorOfId, css, ramp } from "./colors.js";
import { energyCurve } from "./curve.js";
import { element } from "./element.js";
import { SIGMA_FULL_M } from "./objects.js";

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

/** Rows of a name and a value, or a value for each of two methods. */
function figures(rows) {
  const list = element("dl", { className: rows[0].length > 2 ? "figures two" : "figures" });
  for (const [name, ...values] of rows) list.append(element("dt", { text: name }), ...values.map((text) => element("dd", { text })));
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

/** What is said of one method's fit: [name, value]. */
function fitFigures({ object, decoded }) {
  const sigmas = decoded ? [...decoded.sigmas].sort((a, b) => a - b) : [];
  const seen = decoded ? decoded.seen.reduce((sum, one) => sum + one, 0) / Math.max(1, decoded.count) : 0;
  const { evidence } = object;
  const size = [object.extentsM.x, object.extentsM.y, object.extentsM.z].map(mm).join(" × ");
  return [
    ["Method", object.method], ["Size", `${size} mm`], ["Volume, filled", `${(1000 * object.volumeFilledM3).toFixed(3)} l`], ["Volume, material", `${(1000 * object.volumeMaterialM3).toFixed(3)} l`],
    ["Surface seen", percent(seen)], ["Median sigma", sigmas.length ? `${mm(sigmas[sigmas.length >> 1])} mm` : "–"], ["RMS to the points", `${(1000 * evidence.rmsM).toFixed(1)} mm`],
    ["Silhouette IoU", evidence.silhouetteIou.toFixed(2)], ["Fit similarity", evidence.fitSimilarity.toFixed(2)], ["Mesh", `${object.vertices.count} vertices, ${object.closed ? "closed" : "OPEN"}`],
    ["Iterations", `${object.iterations}${object.converged ? "" : ", not settled"}`],
  ];
}

/** Control points by hand: a way into it, or what it shows. Touched only when something of it changes: it is worked with while scenes go on. */
function showControlPoints(object, retype) {
  const box = $("points");
  const isOpen = Boolean(retype?.isOpen), isOffered = Boolean(retype && object.primitive);
  const content = isOpen ? retype.show() : null;
  const key = isOffered ? `${object.primitive} ${isOpen} ${content?.className} ${content?.className === "hint" ? content.textContent : ""} ${object.id}` : "";
  if (box.dataset.key === key) return;
  box.dataset.key = key;
  if (!isOffered) return box.replaceChildren();
  const open = element("button", { type: "button", id: "retype", text: "Retype…" });
  open.addEventListener("click", () => retype.open(object));
  box.replaceChildren(element("h2", { text: `Control points of ${object.primitive}` }), content ?? open);
}

/** Of the picked object ({object, decoded}), with what a second method made of it where there is one. `retype`: null where gfpd does not offer it. */
export function showDetails(picked, second, retype) {
  const box = $("details");
  box.hidden = !picked;
  if (!picked) return;
  const { object } = picked;
  const classes = Object.entries(object.classProbabilities).sort((a, b) => b[1] - a[1]).slice(0, 5);
  const best = object.grasps[0];
  const grasp = best
    ? [["Width", `${mm(best.widthM)} mm`], ["Epsilon", best.epsilon.toFixed(3)], ["P(force closure)", percent(best.pForceClosure)], ["Contacts seen", best.visibility], ["Clearance", `${mm(best.collisionMarginM)} mm`], ["Advice", best.abstain ? "abstain: too uncertain" : "execute"]]
    : [["None", object.noGraspReason.replaceAll("_", " ")]];
  let pairs = fitFigures(picked);
  if (second) {
    const others = fitFigures(second);
    pairs = pairs.map((row, i) => [...row, others[i][1]]);
  }
  $("figures").replaceChildren(
    element("h2", { text: `${object.className} #${object.id}` }),
    bars(classes.map(([name, p]) => ({ name, value: p, text: percent(p), color: css(colorOfId(object.id)) })), 1),
    element("h2", { text: "Fit" }), figures(pairs),
    element("h2", { text: "Energy of the contour" }), energyCurve([{ object, color: css(SEEN) }, ...(second ? [{ object: second.object, color: css(SECOND_SEEN) }] : [])]),
    element("h2", { text: "Best grasp" }), figures(grasp));
  showControlPoints(object, retype);
}

const FRAME_BUDGET_MS = 33;

/** `age_ms`: since the frame was taken; null: of a recording. */
export function showStages(scene, age_ms) {
  const stages = Object.entries(scene.ms).filter(([name]) => name !== "total");
  const total = scene.ms.total ?? stages.reduce((sum, [, ms]) => sum + ms, 0);
  const rows = stages.sort((a, b) => b[1] - a[1]).map(([name, ms]) => ({ name: name.replaceAll("_", " "), value: ms, text: `${ms.toFixed(1)} ms`, color: ms > FRAME_BUDGET_MS ? "var(--inferred)" : undefined }));
  $("stages").replaceChildren(bars(rows, Math.max(FRAME_BUDGET_MS, total)));
  $("total").textContent = age_ms === null ? `${total.toFixed(0)} ms` : `${total.toFixed(0)} ms · ${Math.max(0, age_ms).toFixed(0)} ms old`;
}

export function showSensors(statuses) {
  $("sensors").replaceChildren(
    ...[...statuses.values()].map((status) => {
      const isWell = ["streaming", "ended", "paused"].includes(status.state);
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

/** `methods`: null, or {main, second, compare} where a second method's meshes are shown too. */
export function showLegend(mode, methods) {
  const swatch = (color, text) => {
    const box = element("i");
    box.style.background = css(color);
    return element("span", {}, box, document.createTextNode(text));
  };
  const name = (text) => element("b", { text });
  const scale = () => {
    const scale = element("span", { className: "ramp" });
    scale.style.background = `linear-gradient(90deg, ${[0, 0.25, 0.5, 0.75, 1].map((t) => css(ramp(t))).join(", ")})`;
    return [element("span", { text: "sigma 0" }), scale, element("span", { text: `${mm(SIGMA_FULL_M)} mm` })];
  };
  const key = (isSecond) => [swatch(isSecond ? SECOND_SEEN : SEEN, "seen"), swatch(isSecond ? SECOND_INFERRED : INFERRED, "inferred")];
  const legend = $("legend");
  if (mode === "seen" && methods) legend.replaceChildren(...(methods.compare === "beside" ? [name(methods.main), ...key(false)] : []), name(methods.second), ...key(true));
  else {
    const names = !methods ? [] : methods.compare === "beside" ? [name(`${methods.main}; labelled, to the right: ${methods.second}`)] : [name(methods.second)];
    legend.replaceChildren(...names, ...(mode === "seen" ? key(false) : mode === "sigma" ? scale() : [element("span", { text: "a colour an object" })]));
  }
}

export function showConnection(state) {
  const pill = $("connection");
  pill.textContent = { live: "live", restarted: "live", lost: "no connection", connecting: "connecting", paused: "paused", replay: "replay" }[state];
  pill.className = `pill ${{ live: "live", restarted: "live", replay: "live", lost: "lost" }[state] ?? ""}`;
  $("notice").textContent = state === "lost" ? "gfpd does not answer. Trying again…" : state === "connecting" ? "Connecting…" : "";
}
