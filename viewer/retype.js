// Saying by hand which vertices of a primitive are control points: they stand as dots on the picked mesh, are chosen by click or by part,
// and what they become is kept by gfpd, apart from what it finds by itself.
import * as THREE from "three";
import { element } from "./element.js";

export const RETYPE = "/gfp/primitive/retype";
const AUTOMATIC = 0, REGULAR = 1, CONTROL = 2; // gfp.v1.RetypeRequest.Type
const PARTS = ["body", "base", "rim", "inner wall", "handle", "neck", "cap", "spout"];
const COLORS = { control: [1.0, 0.82, 0.25], regular: [0.62, 0.68, 0.75], chosen: [0.42, 0.66, 1.0] };
const NEAR_px = 14;

export class Retype {
  /** `call(fields)` asks the service; `onChange()` is told when there is something to draw. */
  constructor(world, call, onChange) {
    Object.assign(this, { world, call, onChange });
    this.dots = new THREE.Points(new THREE.BufferGeometry(), new THREE.PointsMaterial({ size: 7, sizeAttenuation: false, vertexColors: true, depthTest: false }));
    this.dots.renderOrder = 1;
    this.panel = element("section", { className: "retype" });
    this.target = null; // {id, primitive}
  }

  get isOpen() {
    return this.target !== null;
  }

  async open(object) {
    this.target = { id: object.id, primitive: object.primitive };
    this.chosen = new Set();
    this.types = this.manual = null;
    this.said = "";
    await this.ask({ vertices: [] });
  }

  close() {
    this.target = null;
    this.dots.removeFromParent();
    this.onChange();
  }

  async ask({ vertices, type = AUTOMATIC }) {
    const { primitive } = this.target;
    try {
      const answer = await this.call({ primitive, vertices, type });
      if (this.target?.primitive !== primitive) return; // closed, or another one by now
      this.types = answer.types;
      this.manual = answer.manualTypes;
      if (vertices.length) this.said = `${answer.changed} changed; holds for fits from now on.`;
      this.chosen.clear();
    } catch (error) {
      this.said = error.message;
    }
    this.onChange();
  }

  /** The dots, where the picked object is now. */
  place() {
    const shown = this.target && this.world.meshes.get(this.target.id);
    if (!shown?.topology || !this.types || this.types.length !== shown.decoded.count) return this.dots.removeFromParent();
    const { positions, count } = shown.decoded, colors = new Float32Array(3 * count);
    for (let i = 0; i < count; ++i) {
      const color = this.chosen.has(i) ? COLORS.chosen : this.types[i] ? COLORS.control : COLORS.regular;
      for (let k = 0; k < 3; ++k) colors[3 * i + k] = color[k] ** 2.2;
    }
    this.dots.geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    this.dots.geometry.setAttribute("color", new THREE.BufferAttribute(colors, 3));
    this.dots.geometry.computeBoundingSphere();
    shown.group.add(this.dots);
  }

  /** The vertex near this place of the canvas (pixels) that is nearest to the eye becomes chosen, or not any more. Returns whether there is one. */
  pick(x, y) {
    if (!this.dots.parent) return false;
    const { clientWidth: width, clientHeight: height } = this.world.canvas;
    const positions = this.dots.geometry.getAttribute("position"), at = new THREE.Vector3();
    let best = null, nearest = Infinity;
    for (let i = 0; i < positions.count; ++i) {
      at.fromBufferAttribute(positions, i).applyMatrix4(this.dots.matrixWorld).project(this.world.camera);
      const away = Math.hypot((0.5 + 0.5 * at.x) * width - x, (0.5 - 0.5 * at.y) * height - y);
      if (away < NEAR_px && at.z + 1e-3 * away < nearest) (best = i), (nearest = at.z + 1e-3 * away);
    }
    if (best === null) return false;
    if (!this.chosen.delete(best)) this.chosen.add(best);
    this.onChange();
    return true;
  }

  choosePart(part) {
    const parts = this.world.meshes.get(this.target.id)?.topology?.parts ?? [];
    parts.forEach((one, i) => one === part && this.chosen.add(i));
    this.onChange();
  }

  /** What the panel shows below the picked object's figures. Its buttons stay the same elements, so that none is lost under a finger. */
  show() {
    if (!this.types) return element("p", { className: "hint", text: this.said || "Asking gfpd…" });
    const controls = this.types.reduce((sum, type) => sum + type, 0), byHand = this.manual.reduce((sum, type) => sum + (type ? 1 : 0), 0);
    const summary = `${controls} of ${this.types.length} vertices, ${byHand} of them said by hand. ${this.chosen.size} chosen.`;
    if (!this.panel.childElementCount) this.build();
    this.panel.querySelector(".summary").textContent = summary;
    this.panel.querySelector(".said").textContent = this.said;
    const has = new Set(this.world.meshes.get(this.target.id)?.topology?.parts ?? []);
    for (const option of this.panel.querySelectorAll("option[value]:not([value=''])")) option.hidden = !has.has(Number(option.value));
    for (const button of this.panel.querySelectorAll("button.type")) button.disabled = this.chosen.size === 0;
    return this.panel;
  }

  build() {
    const part = element("select", { ariaLabel: "Choose the vertices of a part" }, element("option", { value: "", text: "Part…" }), ...PARTS.map((text, value) => element("option", { value: String(value), text })));
    part.addEventListener("change", () => (part.value !== "" && this.choosePart(Number(part.value)), (part.value = "")));
    const become = (text, type) => {
      const button = element("button", { type: "button", className: "type", text });
      button.addEventListener("click", () => this.ask({ vertices: [...this.chosen].sort((a, b) => a - b), type }));
      return button;
    };
    const none = element("button", { type: "button", text: "None" }), done = element("button", { type: "button", text: "Done" });
    none.addEventListener("click", () => (this.chosen.clear(), this.onChange()));
    done.addEventListener("click", () => this.close());
    this.panel.append(
      element("p", { className: "summary" }), element("p", { className: "hint", text: "Click the dots to choose them; yellow: control points." }),
      element("div", { className: "row" }, part, none), element("div", { className: "row" }, become("Control", CONTROL), become("Regular", REGULAR), become("By itself", AUTOMATIC)),
      element("p", { className: "said", role: "status" }), element("div", { className: "row" }, done));
  }
}
