// The three-dimensional scene: draws when something changed, and only then.
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Cloud } from "./cloud.js";
import { colorOfId } from "./colors.js";
import { gripper, matrixOf, supportSurface, updateMeshes } from "./objects.js";
import { SecondMethod } from "./second.js";

const MAX_SHOWN_GRASPS = 5;
const UP = new THREE.Vector3(0, 0, 1);

export class World {
  constructor(canvas, labels, onPick) {
    this.canvas = canvas;
    this.labels = labels;
    this.options = { mesh: "seen", points: true, meshes: true, grasps: true, table: true, names: true, compare: "off" };
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, powerPreference: "low-power" });
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(0x11151a);
    this.camera = new THREE.PerspectiveCamera(50, 1, 0.02, 30);
    this.camera.up.copy(UP);
    this.scene.add(new THREE.HemisphereLight(0xdfe9ff, 0x39404a, 1.6), this.camera);
    const lamp = new THREE.DirectionalLight(0xffffff, 1.9);
    lamp.position.set(0.5, 0.8, 1);
    this.camera.add(lamp);
    this.sensor = new THREE.Group(); // the sensor's optical frame in a world whose z is up
    this.sensor.matrixAutoUpdate = false;
    this.scene.add(this.sensor);
    this.cloud = new Cloud();
    this.grasps = new THREE.Group();
    this.table = new THREE.Group();
    this.meshes = new Map();
    this.second = new SecondMethod();
    this.sensor.add(this.cloud.points, this.grasps, this.table, this.second.group);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.level = new THREE.Quaternion(); // turns what the scene calls world so that the table is level
    this.pickFirst = () => false; // who is asked before objects are: true where the click was meant for it
    this.listen(onPick);
    new ResizeObserver(() => this.resize()).observe(canvas);
  }

  listen(onPick) {
    let down = null;
    this.canvas.addEventListener("pointerdown", (event) => (down = [event.clientX, event.clientY]));
    this.canvas.addEventListener("pointerup", (event) => {
      if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 5) return;
      const box = this.canvas.getBoundingClientRect();
      if (this.pickFirst(event.clientX - box.left, event.clientY - box.top)) return;
      const at = new THREE.Vector2((2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height);
      const ray = new THREE.Raycaster();
      ray.setFromCamera(at, this.camera);
      const hit = ray.intersectObjects([...this.shown()].map(({ mesh }) => mesh), false)[0];
      onPick(hit ? hit.object.userData.id : null);
    });
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /** Asks for a picture; several askings before it make one. The page keeps breathing between pictures, however slow they are. */
  draw() {
    if (this.isDue) return;
    this.isDue = true;
    setTimeout(() => requestAnimationFrame(() => this.render()), this.pause_ms ?? 0);
  }

  render() {
    this.isDue = false;
    const start = performance.now();
    this.sensor.updateMatrixWorld(true); // the matrices below are set by hand, which three does not notice
    this.renderer.render(this.scene, this.camera);
    this.placeLabels();
    this.pause_ms = Math.min(200, 0.5 * (performance.now() - start));
    this.pictures = (this.pictures ?? 0) + 1;
  }

  setScene(scene, topologies, selected) {
    this.last = { scene, topologies, selected };
    this.placeSensor(scene);
    updateMeshes(this.meshes, this.sensor, scene.objects, topologies, this.options.mesh, false);
    const supportOfCamera = scene.support ? matrixOf(scene.support.TCameraSupport).invert() : null;
    this.cloud.setObjects(scene.objects.map((object) => ({ box: object.bboxPx, color: colorOfId(object.id) })), supportOfCamera);
    this.replace(this.table, scene.support ? [supportSurface(scene.support)] : []);
    this.showChoice();
    if (!this.isAimed && scene.objects.length) this.aim();
    this.draw();
  }

  /** What another method made of the same objects; null: nothing. */
  setSecond(scene, topologies) {
    this.second.take(scene, topologies, this.options.mesh);
    this.showChoice();
  }

  /** Off, beside or instead of the main method's meshes. */
  setCompare(mode) {
    this.options.compare = mode;
    this.showChoice();
    if (mode === "beside") this.aim();
  }

  /** The meshes that can be seen now, of both methods. */
  *shown() {
    if (!this.options.meshes) return;
    if (this.options.compare !== "instead") yield* this.meshes.values();
    if (this.options.compare !== "off") yield* this.second.meshes.values();
  }

  /** The world's z is the table's normal: what the scene calls world may be the camera's own frame. */
  placeSensor(scene) {
    const worldOfSensor = matrixOf(scene.TWorldSensor);
    if (scene.support) {
      const normal = new THREE.Vector3().setFromMatrixColumn(worldOfSensor.clone().multiply(matrixOf(scene.support.TCameraSupport)), 2);
      if (normal.clone().applyQuaternion(this.level).angleTo(UP) > 0.05) {
        this.level.setFromUnitVectors(normal, UP);
        this.isAimed = false;
      }
    }
    this.sensor.matrix.makeRotationFromQuaternion(this.level).multiply(worldOfSensor);
  }

  replace(group, children) {
    for (const child of [...group.children]) {
      child.traverse((part) => {
        part.material?.dispose();
        if (part.geometry?.type === "ShapeGeometry") part.geometry.dispose();
      });
      group.remove(child);
    }
    if (children.length) group.add(...children);
  }

  /** What depends on the options and on which object is picked. */
  showChoice() {
    const { options, last } = this;
    if (!last) return;
    this.cloud.points.visible = options.points && this.cloud.isReady;
    this.table.visible = options.table;
    this.labels.hidden = !options.names;
    const isShown = new Set(this.shown());
    for (const shown of [...this.meshes.values(), ...this.second.meshes.values()]) {
      shown.group.visible = isShown.has(shown);
      shown.outline.visible = shown.id === last.selected;
    }
    this.second.place(options.compare === "beside" ? this.meshes.values() : null, last.scene);
    const grippers = [];
    if (options.grasps)
      for (const object of last.scene.objects)
        object.grasps.slice(0, object.id === last.selected ? MAX_SHOWN_GRASPS : 1).forEach((grasp, k) => grippers.push(gripper(grasp, k === 0)));
    this.replace(this.grasps, grippers);
    this.draw();
  }

  select(id) {
    if (this.last) this.last.selected = id;
    this.showChoice();
  }

  setMeshMode(mode) {
    this.options.mesh = mode;
    for (const shown of [...this.meshes.values(), ...this.second.meshes.values()]) if (shown.topology) shown.color(mode);
    this.draw();
  }

  /** Looks at the objects from where the sensor is. */
  aim() {
    this.sensor.updateMatrixWorld(true);
    const box = new THREE.Box3();
    for (const shown of this.shown()) {
      shown.group.updateMatrixWorld(true);
      if (shown.topology) box.expandByObject(shown.mesh);
    }
    if (box.isEmpty()) return;
    this.isAimed = true;
    const eye = new THREE.Vector3().setFromMatrixPosition(this.sensor.matrixWorld);
    box.getCenter(this.controls.target);
    const size = Math.max(0.15, box.getSize(new THREE.Vector3()).length());
    this.camera.position.copy(eye).sub(this.controls.target).normalize().multiplyScalar(1.25 * size + 0.25).add(this.controls.target);
    this.controls.update();
    this.draw();
  }

  /** Moves the eye: azimuth and elevation in radians, distance as a factor. */
  orbit(azimuth, elevation, zoom) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const sphere = new THREE.Spherical().setFromVector3(new THREE.Vector3(offset.y, offset.z, offset.x)); // three's y is our z
    sphere.theta += azimuth;
    sphere.phi = Math.min(3.1, Math.max(0.05, sphere.phi - elevation));
    sphere.radius *= zoom;
    const turned = new THREE.Vector3().setFromSpherical(sphere);
    this.camera.position.set(turned.z, turned.x, turned.y).add(this.controls.target);
    this.controls.update();
    this.draw();
  }

  placeLabels() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const wanted = [];
    for (const shown of this.shown()) {
      if (!shown.top) continue;
      const at = shown.top.clone().applyMatrix4(shown.group.matrixWorld).project(this.camera);
      if (at.z > 1) continue;
      wanted.push({ shown, x: (0.5 + 0.5 * at.x) * width, y: (0.5 - 0.5 * at.y) * height });
    }
    while (this.labels.children.length < wanted.length) this.labels.append(document.createElement("span"));
    while (this.labels.children.length > wanted.length) this.labels.lastChild.remove();
    wanted.forEach(({ shown, x, y }, i) => {
      const label = this.labels.children[i];
      label.textContent = shown.isSecond && shown.name === "unknown" ? `#${shown.id}` : shown.name; // methods without classes
      label.className = `${shown.isSecond ? "second" : ""} ${shown.id === this.last.selected ? "selected" : ""}`;
      label.style.transform = `translate(-50%, -100%) translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    });
  }
}
