// What a second method makes of the same objects: shown over their places, or as a row of its own beside them.
import * as THREE from "three";
import { matrixOf, updateMeshes } from "./objects.js";

const GAP_M = 0.12, STEADY_M = 0.05; // the second row stands still while the first one changes by less

export class SecondMethod {
  constructor() {
    this.group = new THREE.Group(); // in the sensor's frame
    this.meshes = new Map();
    this.shift_m = 0;
  }

  take(scene, topologies, mode) {
    updateMeshes(this.meshes, this.group, scene?.objects ?? [], topologies, mode, true);
    this.objects = scene?.objects ?? [];
  }

  /** Beside those meshes: along the table, to the sensor's right, by the width of what is there; null: in their place. */
  place(others, scene) {
    if (!others) return this.group.position.set(0, 0, 0);
    const right = new THREE.Vector3(1, 0, 0);
    if (scene.support) right.projectOnPlane(new THREE.Vector3().setFromMatrixColumn(matrixOf(scene.support.TCameraSupport), 2));
    if (right.lengthSq() < 0.01) right.set(1, 0, 0);
    right.normalize();
    let low = Infinity, high = -Infinity;
    for (const list of [others, this.meshes.values()])
      for (const { mesh, group, topology } of list) {
        if (!topology) continue;
        const { center, radius } = mesh.geometry.boundingSphere;
        const along = center.clone().applyMatrix4(group.matrix).dot(right);
        low = Math.min(low, along - radius);
        high = Math.max(high, along + radius);
      }
    const shift_m = high > low ? high - low + GAP_M : 0;
    if (Math.abs(shift_m - this.shift_m) > STEADY_M) this.shift_m = shift_m;
    this.group.position.copy(right).multiplyScalar(this.shift_m);
  }
}
