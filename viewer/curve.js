// How the energy of an active contour fell, iteration by iteration (Fig. 6 of the paper): a small drawing.
import { element } from "./element.js";

const WIDTH = 300, HEIGHT = 96, LEFT = 34, RIGHT = 8, TOP = 8, BOTTOM = 18;

function svg(tag, attributes, ...children) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

/** Of one or two fits ({object, color}), each as a share of its own start: methods count energy in units of their own. */
export function energyCurve(fits) {
  const curves = fits.map(({ object, color }) => ({ color, method: object.method, shares: shares(object.energies) })).filter(({ shares }) => shares.length > 1);
  if (!curves.length) return element("p", { className: "hint", text: "No contour ran in this fit." });
  const steps = Math.max(...curves.map(({ shares }) => shares.length - 1)), top = Math.max(1, ...curves.flatMap(({ shares }) => shares));
  const x = (step) => LEFT + ((WIDTH - LEFT - RIGHT) * step) / steps, y = (share) => HEIGHT - BOTTOM - ((HEIGHT - TOP - BOTTOM) * share) / top;
  const label = (at, text, anchor) => svg("text", { x: at[0], y: at[1], "text-anchor": anchor }, text);
  const drawing = svg("svg", { class: "curve", viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": curves.map(({ method, shares }) => `${method}: from 100 % to ${percent(shares.at(-1))} in ${shares.length - 1} iterations`).join("; ") },
    svg("line", { x1: LEFT, y1: y(0), x2: WIDTH - RIGHT, y2: y(0) }), svg("line", { x1: LEFT, y1: y(top), x2: LEFT, y2: y(0) }),
    label([LEFT - 4, y(top) + 4], percent(top), "end"), label([LEFT - 4, y(0) + 3], "0", "end"), label([LEFT, HEIGHT - 5], "start", "start"), label([WIDTH - RIGHT, HEIGHT - 5], `after ${steps} iterations`, "end"));
  for (const { color, shares } of curves) {
    drawing.append(svg("polyline", { points: shares.map((share, step) => `${x(step).toFixed(1)},${y(share).toFixed(1)}`).join(" "), stroke: color }));
    shares.forEach((share, step) => drawing.append(svg("circle", { cx: x(step).toFixed(1), cy: y(share).toFixed(1), r: 2.2, fill: color })));
    drawing.append(label([x(shares.length - 1), Math.max(TOP + 4, y(shares.at(-1)) - 6)], percent(shares.at(-1)), "end"));
  }
  return drawing;
}

const percent = (share) => `${Math.round(100 * share)} %`;
const shares = (energies) => (energies.length && energies[0] > 0 ? energies.map((energy) => energy / energies[0]) : []);
