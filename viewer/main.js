// The page: newest message of each topic in, picture and figures out.
import { Connection } from "./connection.js";
import { element } from "./element.js";
import { showConnection, showDetails, showLegend, showObjects, showSensors, showStages } from "./panel.js";
import { Player } from "./player.js";
import { RETYPE, Retype } from "./retype.js";
import { World } from "./world.js";

const $ = (id) => document.getElementById(id);
const state = { selected: null, scene: null, sensor: null, sensors: [], scenes: new Map(), seconds: new Map(), topologies: new Map(), statuses: new Map(), isPaused: false, pointMode: "colour", second: null, meshMode: "seen" };
const world = new World($("canvas"), $("labels"), select);
const retype = new Retype(world, (fields) => connection.call(RETYPE, fields), () => {
  retype.place();
  showChoice();
  world.draw();
});
world.pickFirst = (x, y) => retype.isOpen && retype.pick(x, y);

const player = new Player((request) => connection.steer(request));

const SHADOW = /^\/gfp\/shadow\/([^/]+)\/$/;
const STREAM = /^\/gfp\/sensor\/([^/]+)\/(depth|color|camera)\/$/;

/** What is worth its bandwidth: images only where the points are drawn, and of one sensor. */
function wanted(topic) {
  if (["/gfp/scene/", "/gfp/mesh/", "/gfp/status/"].includes(topic)) return true;
  if (SHADOW.test(topic)) return world.options.compare !== "off";
  const stream = STREAM.exec(topic);
  if (!stream) return false;
  state.sensor ??= stream[1];
  if (stream[1] !== state.sensor) return false;
  if (stream[2] === "camera") return true;
  return world.options.points && !document.hidden && !(stream[2] === "color" && state.pointMode === "distance");
}

function onMessage(topic, read, logTime_ms) {
  const stream = STREAM.exec(topic);
  if (topic === "/gfp/mesh/") {
    const topology = read();
    if (!state.topologies.has(topology.hash)) state.topologies.set(topology.hash, topology);
  } else if (topic === "/gfp/status/") {
    const status = read();
    state.statuses.set(status.sensor, status);
    showSensors(state.statuses);
  } else if (state.isPaused || document.hidden) {
    return;
  } else if (topic === "/gfp/scene/") {
    const scene = read();
    state.scenes.set(scene.header.sensor, scene);
    if (state.sensor === null || scene.header.sensor === state.sensor) takeScene(scene, player.isActive ? null : Date.now() - logTime_ms);
  } else if (SHADOW.test(topic)) {
    const scene = read();
    state.seconds.set(scene.header.sensor, scene);
    if (state.sensor === null || scene.header.sensor === state.sensor) takeSecond(scene);
  } else if (stream[2] === "camera") {
    world.cloud.setCalibration(read());
    world.showChoice();
  } else {
    if (stream[2] === "depth") world.cloud.setDepth(read());
    else world.cloud.setColor(read());
    world.showChoice();
  }
}

function takeScene(scene, age_ms) {
  state.scene = scene;
  if (state.selected !== null && !scene.objects.some(({ id }) => id === state.selected)) state.selected = null;
  if (retype.isOpen && retype.target.id !== state.selected) retype.close();
  world.setScene(scene, state.topologies, state.selected);
  retype.place();
  legend();
  showStages(scene, age_ms);
  showChoice();
}

function takeSecond(scene) {
  if (world.options.compare === "off") return; // what was on its way
  state.second = scene;
  world.setSecond(scene, state.topologies);
  legend();
  showChoice();
}

function showChoice() {
  if (!state.scene) return;
  showObjects(state.scene, state.selected, select);
  const picked = (scene, meshes) => {
    const object = scene?.objects.find(({ id }) => id === state.selected);
    return object && { object, decoded: meshes.get(state.selected)?.decoded };
  };
  showDetails(picked(state.scene, world.meshes), world.options.compare === "off" ? undefined : picked(state.second, world.second.meshes), connection.services.has(RETYPE) ? retype : null);
}

function legend() {
  const main = state.scene?.objects[0]?.method ?? "";
  showLegend(state.meshMode, world.options.compare === "off" ? null : { main, second: state.second?.profile ?? "…", compare: world.options.compare });
}

function select(id) {
  if (retype.isOpen && retype.target.id !== id) retype.close();
  state.selected = id;
  world.select(id);
  showChoice();
}

function selectNext(step) {
  const ids = state.scene?.objects.map(({ id }) => id) ?? [];
  if (!ids.length) return;
  const at = ids.indexOf(state.selected);
  select(ids[at < 0 ? (step > 0 ? 0 : ids.length - 1) : (at + step + ids.length) % ids.length]);
}

/** Of a replay the replay halts; of a live sensor only what is shown. */
function pause() {
  if (player.isActive) return player.toggle();
  state.isPaused = !state.isPaused;
  $("pause").setAttribute("aria-pressed", state.isPaused);
  $("pause").textContent = state.isPaused ? "Resume" : "Pause";
  showConnection(state.isPaused ? "paused" : connection.socket.readyState === WebSocket.OPEN ? "live" : "lost");
}

/** Buttons of which one is on. */
function radioGroup(parent, title, choices, initial, onChoose) {
  const buttons = choices.map(([value, text]) => {
    const button = element("button", { text, type: "button" });
    button.setAttribute("role", "radio");
    button.addEventListener("click", () => choose(value));
    return [value, button];
  });
  function choose(value) {
    for (const [mine, button] of buttons) button.setAttribute("aria-checked", mine === value);
    onChoose(value);
  }
  parent.append(element("span", { text: title }), ...buttons.map(([, button]) => button));
  choose(initial);
  return choose;
}

const chooseMesh = radioGroup($("mesh-mode"), "Meshes", [["seen", "Seen"], ["sigma", "Sigma"], ["object", "Object"]], "seen", (mode) => {
  state.meshMode = mode;
  world.setMeshMode(mode);
  legend();
});
const choosePoints = radioGroup($("cloud-mode"), "Points", [["colour", "Colour"], ["distance", "Distance"], ["objects", "Objects"]], "colour", (mode) => {
  state.pointMode = mode;
  world.cloud.setMode(mode);
  connection?.review();
  world.draw();
});

var connection = null; // the choices above ask for it before it is made

const chooseCompare = radioGroup($("compare"), "Second", [["off", "Off"], ["beside", "Beside"], ["instead", "Instead"]], "off", (mode) => {
  world.setCompare(mode);
  if (mode === "off") world.setSecond((state.second = null), state.topologies);
  legend();
  connection?.review();
  showChoice();
});

/** Of several sensors the picture is one's; the others' last scenes are kept for when they are chosen. */
function lookThrough(sensor) {
  if (sensor === state.sensor) return;
  state.sensor = sensor;
  world.cloud.reset();
  connection.review();
  const scene = state.scenes.get(sensor), second = state.seconds.get(sensor);
  if (scene) takeScene(scene, null);
  if (second) takeSecond(second);
  world.showChoice();
}

let chooseSensor = null;
function takeSensors(names) {
  if (names.join() === state.sensors.join()) return;
  state.sensors = names;
  $("sensor-choice").replaceChildren();
  $("sensor-choice").hidden = names.length < 2;
  if (names.length && !names.includes(state.sensor)) lookThrough(names[0]);
  chooseSensor = radioGroup($("sensor-choice"), "Sensor", names.map((name) => [name, name]), state.sensor, lookThrough);
}

function takeTopics(topics) {
  takeSensors([...new Set(topics.map((topic) => STREAM.exec(topic)?.[1]).filter(Boolean))].sort());
  const hasSecond = topics.some((topic) => SHADOW.test(topic));
  $("compare").hidden = !hasSecond;
  if (!hasSecond && world.options.compare !== "off") chooseCompare("off");
}

const toggles = new Map();
for (const [option, text] of [["points", "Points"], ["meshes", "Meshes"], ["grasps", "Grasps"], ["table", "Table"], ["names", "Names"]]) {
  const button = element("button", { text, type: "button" });
  const toggle = () => {
    world.options[option] = !world.options[option];
    button.setAttribute("aria-pressed", world.options[option]);
    connection.review();
    world.showChoice();
  };
  button.setAttribute("aria-pressed", true);
  button.addEventListener("click", toggle);
  toggles.set(option, toggle);
  $("toggles").append(button);
}

const KEYS = [
  ["↑ ↓", "Next or previous object", ["ArrowUp", "ArrowDown"], (key) => selectNext(key === "ArrowDown" ? 1 : -1)],
  ["Esc", "No object", ["Escape"], () => select(null)],
  ["← →", "Turn", ["ArrowLeft", "ArrowRight"], (key) => world.orbit(key === "ArrowLeft" ? -0.15 : 0.15, 0, 1)],
  ["PgUp PgDn", "Look from higher or lower", ["PageUp", "PageDown"], (key) => world.orbit(0, key === "PageUp" ? 0.12 : -0.12, 1)],
  ["+ −", "Nearer or farther", ["+", "=", "-"], (key) => world.orbit(0, 0, key === "-" ? 1.15 : 1 / 1.15)],
  ["Home", "Look from the sensor", ["Home"], () => world.aim()],
  ["1 2 3", "Meshes: seen, sigma, object", ["1", "2", "3"], (key) => chooseMesh(["seen", "sigma", "object"][key - 1])],
  ["4 5 6", "Points: colour, distance, objects", ["4", "5", "6"], (key) => choosePoints(["colour", "distance", "objects"][key - 4])],
  ["P M G T N", "Points, meshes, grasps, table, names on or off", ["p", "m", "g", "t", "n"], (key) => toggles.get({ p: "points", m: "meshes", g: "grasps", t: "table", n: "names" }[key])()],
  ["C", "Second method, where one runs: off, beside, instead", ["c"], () => $("compare").hidden || chooseCompare({ off: "beside", beside: "instead", instead: "off" }[world.options.compare])],
  ["V", "Look through the next sensor, where there are several", ["v"], () => state.sensors.length > 1 && chooseSensor(state.sensors[(state.sensors.indexOf(state.sensor) + 1) % state.sensors.length])],
  ["Space", "Pause; of a replay, the replay", [" "], pause],
  [", .", "Of a replay: a frame back or on", [",", "."], (key) => player.isActive && player.step(key === "," ? -1 : 1)],
  ["Shift+← →", "Of a replay: a second back or on", ["Shift+ArrowLeft", "Shift+ArrowRight"], (key) => player.isActive && player.jump(key === "Shift+ArrowLeft" ? -1 : 1)],
  ["?", "This list", ["?"], () => $("help").showModal()],
];
for (const [keys, text] of KEYS) $("keys").append(element("dt", {}, ...keys.split(" ").map((key) => element("kbd", { text: key }))), element("dd", { text }));
document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || $("help").open) return;
  if (event.key === " " && event.target instanceof HTMLButtonElement) return; // it presses the button
  if (event.target.matches("input, select") && /^(Arrow|Page|Home|End)/.test(event.key)) return; // it moves the slider, or the choice
  const key = event.shiftKey && event.key.startsWith("Arrow") ? `Shift+${event.key}` : event.key;
  const found = KEYS.find(([, , keys]) => keys.includes(key));
  if (!found) return;
  event.preventDefault();
  found[3](key);
});
$("pause").addEventListener("click", pause);
$("help-button").addEventListener("click", () => $("help").showModal());

connection = new Connection(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/${location.search}`, {
  wanted,
  onMessage,
  onTopics: takeTopics,
  onPlayback: (playback) => {
    player.show(playback);
    $("pause").hidden = playback !== null; // the player bar has the button
    if (playback) showConnection("replay");
  },
  onState: (now) => {
    if (now === "restarted") for (const kept of [state.topologies, state.statuses, state.scenes, state.seconds]) kept.clear();
    if (!state.isPaused) showConnection(now);
  },
});
document.addEventListener("visibilitychange", () => connection.review());
window.gfp = { state, world, player, retype }; // for whoever looks from the browser's console, and for the tests
