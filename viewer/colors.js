// Colours of classes and scales, as [r, g, b] in 0..1 (sRGB).
export const SECOND_SEEN = [0.64, 0.53, 0.96], SECOND_INFERRED = [0.95, 0.47, 0.66]; // of the second method
export const SEEN = [0.32, 0.78, 0.63], INFERRED = [0.94, 0.63, 0.29];

const RAMP = [[0.27, 0.0, 0.33], [0.23, 0.32, 0.55], [0.13, 0.57, 0.55], [0.37, 0.79, 0.38], [0.99, 0.91, 0.14]]; // viridis, by its quarters

/** Viridis at t in 0..1. */
export function ramp(t) {
  const at = Math.min(0.9999, Math.max(0, t)) * (RAMP.length - 1);
  const low = RAMP[Math.floor(at)], high = RAMP[Math.floor(at) + 1], share = at % 1;
  return low.map((value, k) => value + share * (high[k] - value));
}

/** A colour of its own for each object: the golden angle keeps neighbours apart. */
export function colorOfId(id) {
  const hue = ((Number(id) * 137.508) % 360) / 60;
  const saturation = 0.62, value = 0.92;
  return [5, 3, 1].map((offset) => {
    const k = (offset + hue) % 6;
    return value - value * saturation * Math.max(0, Math.min(k, 4 - k, 1));
  });
}

export const css = (color) => `rgb(${color.map((value) => Math.round(255 * value)).join(" ")})`;

/** Red over yellow to green: how sure a grasp is. */
export const certainty = (p) => [Math.min(1, 2 * (1 - p)) * 0.9 + 0.1, Math.min(1, 2 * p) * 0.8 + 0.1, 0.25];
