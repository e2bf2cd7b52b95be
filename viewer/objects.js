// Meshes and grasps of a scene as things to draw.
import * as THREE from "three";
import { INFERRED, SECOND_INFERRED, SECOND_SEEN, SEEN, certainty, colorOfId, ramp } from "./colors.js";

export const SIGMA_FULL_M = 0.02; // the end of the colour scale

export function matrixOf(transform) {
  return new THREE.Matrix4().set(...transform.matrix); // both are row-major
}

const wordsOf = (bytes, Type) => new Type(bytes.slice().buffer);

/** Positions (metres, object frame), sigmas (metres) and which vertices were seen. */
export function decodeVertices(vertices) {
  const count = vertices.count, isInt16 = vertices.encoding === 1;
  const raw = wordsOf(vertices.positions, isInt16 ? Int16Array : Float32Array);
  const positions = isInt16 ? Float32Array.from(raw, (value, i) => vertices.origin[i % 3] + vertices.scale * value) : raw;
  const sigmas = isInt16 ? Float32Array.from(wordsOf(vertices.sigma, Uint16Array), (value) => vertices.sigmaScale * value) : wordsOf(vertices.sigma, Float32Array);
  const seen = Uint8Array.from(vertices.states, (state) => state & 1);
  return { count, positions, sigmas, seen };
}

function vertexColors(mode, { id, isSecond, decoded: { count, sigmas, seen } }) {
  const colors = new Float32Array(3 * count), own = colorOfId(id);
  const [whenSeen, whenInferred] = isSecond ? [SECOND_SEEN, SECOND_INFERRED] : [SEEN, INFERRED];
  for (let i = 0; i < count; ++i) {
    const color = mode === "sigma" ? ramp(sigmas[i] / SIGMA_FULL_M) : mode === "object" ? own : seen[i] ? whenSeen : whenInferred;
    for (let k = 0; k < 3; ++k) colors[3 * i + k] = color[k] ** 2.2; // sRGB to linear
  }
  return new THREE.BufferAttribute(colors, 3);
}

const MESH = new THREE.MeshStandardMaterial({ vertexColors: true, roughness: 0.62, metalness: 0.02, side: THREE.DoubleSide });
const OUTLINE = new THREE.MeshBasicMaterial({ color: 0x6aa8ff, side: THREE.BackSide });
const BOX = new THREE.BoxGeometry(1, 1, 1);

export class ObjectMesh {
  constructor(id, isSecond = false) {
    this.id = id;
    this.isSecond = isSecond; // of the method beside the main one
    this.group = new THREE.Group();
    this.group.matrixAutoUpdate = false;
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), MESH);
    this.mesh.userData.id = id;
    this.outline = new THREE.Mesh(this.mesh.geometry, OUTLINE);
    this.outline.visible = false;
    this.group.add(this.outline, this.mesh);
  }

  update(object, topology, mode) {
    this.decoded = decodeVertices(object.vertices);
    this.group.matrix.copy(matrixOf(object.TCameraObject));
    if (!topology) return;
    const geometry = this.mesh.geometry;
    if (this.topology !== topology) {
      this.topology = topology;
      geometry.setIndex(new THREE.BufferAttribute(wordsOf(topology.triangles, Uint32Array), 1));
      geometry.deleteAttribute("position");
      geometry.deleteAttribute("normal");
    }
    geometry.setAttribute("position", new THREE.BufferAttribute(this.decoded.positions, 3));
    geometry.computeVertexNormals();
    geometry.computeBoundingSphere();
    this.color(mode);
    const centre = geometry.boundingSphere.center, swell = 1 + 0.004 / Math.max(0.01, geometry.boundingSphere.radius);
    this.outline.scale.setScalar(swell);
    this.outline.position.copy(centre).multiplyScalar(1 - swell);
    this.top = new THREE.Vector3(centre.x, centre.y, this.decoded.positions.reduce((top, value, i) => (i % 3 === 2 ? Math.max(top, value) : top), 0) + 0.015);
  }

  color(mode) {
    this.mesh.geometry.setAttribute("color", vertexColors(mode, this));
  }

  dispose() {
    this.mesh.geometry.dispose();
  }
}

/** Brings the meshes by id to what a scene's objects are: new ones come into `parent`, those that are gone leave it. */
export function updateMeshes(meshes, parent, objects, topologies, mode, isSecond) {
  const present = new Set();
  for (const object of objects) {
    present.add(object.id);
    let shown = meshes.get(object.id);
    if (!shown) {
      shown = new ObjectMesh(object.id, isSecond);
      meshes.set(object.id, shown);
      parent.add(shown.group);
    }
    shown.update(object, topologies.get(object.vertices.topologyHash), mode);
    shown.name = object.className;
    shown.method = object.method;
  }
  for (const [id, shown] of meshes) {
    if (present.has(id)) continue;
    parent.remove(shown.group);
    shown.dispose();
    meshes.delete(id);
  }
}

/** A parallel jaw: x along the approach, y along the closing axis, the origin between the tips. */
export function gripper(grasp, isBest) {
  const group = new THREE.Group();
  group.matrixAutoUpdate = false;
  group.matrix.copy(matrixOf(grasp.TCameraTcp));
  const [r, g, b] = grasp.abstain ? [0.55, 0.58, 0.62] : certainty(grasp.pForceClosure);
  const material = new THREE.MeshStandardMaterial({ color: new THREE.Color().setRGB(r, g, b, THREE.SRGBColorSpace), roughness: 0.5, transparent: !isBest, opacity: isBest ? 1 : 0.35 });
  const half = 0.5 * grasp.widthM + 0.006, finger = 0.045, thick = 0.007;
  const add = (x, y, length, width) => {
    const box = new THREE.Mesh(BOX, material);
    box.position.set(x, y, 0);
    box.scale.set(length, width, 0.014);
    group.add(box);
  };
  for (const side of [-1, 1]) add(-0.5 * finger, side * (half + 0.5 * thick), finger, thick);
  add(-finger - 0.5 * thick, 0, thick, 2 * (half + thick));
  add(-finger - 0.03, 0, 0.05, 0.011);
  return group;
}

/** The seen outline of the table, with a grid of 10 cm. */
export function supportSurface(support) {
  const group = new THREE.Group();
  group.matrixAutoUpdate = false;
  group.matrix.copy(matrixOf(support.TCameraSupport));
  const corners = [];
  for (let i = 0; i + 1 < support.polygon.length; i += 2) corners.push(new THREE.Vector2(support.polygon[i], support.polygon[i + 1]));
  if (corners.length < 3) return group;
  const sheet = new THREE.Mesh(new THREE.ShapeGeometry(new THREE.Shape(corners)), new THREE.MeshBasicMaterial({ color: 0x5a7fb0, transparent: true, opacity: 0.1, depthWrite: false, side: THREE.DoubleSide }));
  const rim = new THREE.LineLoop(new THREE.BufferGeometry().setFromPoints(corners), new THREE.LineBasicMaterial({ color: 0x6f8fb8, transparent: true, opacity: 0.6 }));
  group.add(sheet, rim);
  return group;
}
