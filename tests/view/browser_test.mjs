// The page in a real browser: what it shows is what the daemon publishes, by mouse and by keyboard, on a laptop and on a tablet.
//   node browser_test.mjs PORT PICTURES_DIR      leaves its screenshots there, for eyes
import assert from "node:assert/strict";
import { join } from "node:path";
import { openPage } from "./browser.mjs";

const [port, pictures] = process.argv.slice(2);
const { page, drawn, picture, close } = await openPage(port, pictures);
/** Share of the canvas that is not its background. */
const painted = () => page.evaluate(() => {
  const { world } = window.gfp, gl = world.renderer.getContext();
  world.renderer.render(world.scene, world.camera);
  const { drawingBufferWidth: width, drawingBufferHeight: height } = gl, pixels = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let count = 0;
  for (let i = 0; i < pixels.length; i += 4) count += Math.abs(pixels[i] - 0x11) + Math.abs(pixels[i + 1] - 0x15) + Math.abs(pixels[i + 2] - 0x1a) > 24;
  return count / (width * height);
});
const selected = () => page.evaluate(() => (window.gfp.state.selected === null ? null : String(window.gfp.state.selected)));

await page.waitForFunction(() => window.gfp?.state.scene?.objects.length >= 2 && [...window.gfp.world.meshes.values()].every((shown) => shown.topology) && window.gfp.world.cloud.points.visible);
await page.keyboard.press("Space"); // paused: what follows is about one scene
assert.equal(await page.locator("#pause").getAttribute("aria-pressed"), "true");
await page.evaluate(() => window.gfp.world.aim());
await picture("laptop");
assert.ok((await painted()) > 0.1, "the picture is empty");

const objects = await page.evaluate(() => window.gfp.state.scene.objects.map(({ id, className }) => [String(id), className]));
assert.deepEqual(await page.locator("#objects li").evaluateAll((items) => items.map((item) => [item.dataset.id, item.querySelector("b").textContent])), objects, "the list is the scene's");
assert.equal(await page.locator("#labels span").count(), objects.length);
assert.ok((await page.locator("#stages i").count()) > 0, "no stages"); // a scene that stands still has few
assert.match(await page.locator("#sensors").textContent(), /virtual.*per s.*dropped/s);

await page.locator("#objects li").nth(1).click();
assert.equal(await selected(), objects[1][0]);
assert.match(await page.locator("#details").textContent(), /Volume, filled[\d.]+ l.*Surface seen\d+ %.*Median sigma[\d.]+ mm.*Best grasp/s);
await picture("picked");
await page.keyboard.press("ArrowDown");
assert.notEqual(await selected(), objects[1][0]);
await page.keyboard.press("Escape");
assert.equal(await selected(), null);
// A click on an object in the picture picks it: where its label's object is projected.
const place = await page.evaluate(() => {
  const { world } = window.gfp, box = world.canvas.getBoundingClientRect();
  const shown = [...world.meshes.values()].sort((a, b) => a.group.matrixWorld.elements[14] - b.group.matrixWorld.elements[14]).at(-1);
  const at = shown.mesh.geometry.boundingSphere.center.clone().applyMatrix4(shown.mesh.matrixWorld).project(world.camera);
  return [box.left + (0.5 + 0.5 * at.x) * box.width, box.top + (0.5 - 0.5 * at.y) * box.height];
});
await page.mouse.click(...place);
assert.notEqual(await selected(), null, "a click into an object picked nothing");

await page.keyboard.press("2");
assert.equal(await page.locator("#mesh-mode [aria-checked=true]").textContent(), "Sigma");
await picture("sigma");
await page.keyboard.press("6");
await page.keyboard.press("m");
await picture("segments");
await page.keyboard.press("m");
await page.keyboard.press("p");
await page.keyboard.press("3");
await picture("meshes");
await page.keyboard.press("?");
await page.locator("#help[open]").waitFor();
await page.screenshot({ path: join(pictures, "keys.png") });
await page.keyboard.press("Escape");
await page.keyboard.press("p");
await page.keyboard.press("1");
await page.keyboard.press("4");

await page.setViewportSize({ width: 768, height: 1024 });
await picture("tablet");
const [stage, panel] = await page.evaluate(() => ["stage", "panel"].map((id) => document.getElementById(id).getBoundingClientRect().toJSON()));
assert.ok(stage.bottom <= panel.top + 1 && panel.bottom <= 1025 && panel.width <= 768, "picture and panel overlap on a tablet");
assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "the page is wider than the tablet");

// Nothing is drawn while nothing changes.
await drawn();
const still = await page.evaluate(() => new Promise((resolve) => { const before = window.gfp.world.pictures; setTimeout(() => resolve(window.gfp.world.pictures - before), 1000); }));
assert.ok(still <= 1, `${still} pictures in a second of nothing`);
await page.keyboard.press("Space");
const sequence = await page.evaluate(() => window.gfp.state.scene.header.sequence);
await page.waitForFunction((before) => window.gfp.state.scene.header.sequence > before, sequence);

// A second method beside the first one, and instead of it.
assert.ok(await page.locator("#player").isHidden(), "a player bar without a recording");
await page.setViewportSize({ width: 1280, height: 800 });
await page.keyboard.press("c");
await page.waitForFunction(() => window.gfp.state.second?.objects.length >= 1 && [...window.gfp.world.second.meshes.values()].every((shown) => shown.topology));
await page.keyboard.press("Space");
const second = await page.evaluate(() => String(window.gfp.state.second.objects[0].id));
await page.locator(`#objects li[data-id="${second}"]`).click();
await page.evaluate(() => window.gfp.world.aim());
await picture("second_beside");
assert.match(await page.locator("#legend").textContent(), /gfp_robustseeninferredsuperquadricseeninferred/);
assert.match(await page.locator("#details").textContent(), /Methodgfp_robustsuperquadric.*Silhouette IoU[\d.]+[\d.]+/s);
assert.ok((await page.locator("#labels span.second").count()) >= 1);
const apart = await page.evaluate(() => {
  const { world } = window.gfp;
  return [...world.second.meshes].map(([id, shown]) => world.meshes.get(id)?.group.localToWorld(world.meshes.get(id).top.clone()).distanceTo(shown.group.localToWorld(shown.top.clone())));
});
assert.ok(apart.every((distance) => distance === undefined || distance > 0.15), `beside is ${apart} m away`);
await page.keyboard.press("c");
await picture("second_instead");
assert.equal(await page.locator("#labels span.second").count(), await page.locator("#labels span").count());
assert.doesNotMatch(await page.locator("#legend").textContent(), /gfp_robust/);
await page.keyboard.press("c");
await drawn();
assert.equal(await page.locator("#labels span.second").count(), 0);

// The energy curve of the picked object is what the scene says of it.
const energies = await page.evaluate(() => window.gfp.state.scene.objects.find(({ id }) => id === window.gfp.state.selected).energies);
if (energies.length > 1) assert.equal(await page.locator("#details .curve circle").count(), energies.length);
else assert.match(await page.locator("#details").textContent(), /No contour ran/);
await page.setViewportSize({ width: 1280, height: 1500 });
await picture("figures");

// Control points by hand: by part, by click, taken back.
const mug = await page.evaluate(() => String(window.gfp.state.scene.objects.find(({ className }) => className === "mug").id));
await page.locator(`#objects li[data-id="${mug}"]`).click();
await page.locator("#retype").click();
const summary = page.locator(".retype .summary"), said = page.locator(".retype .said");
await summary.waitFor();
const automatic = await summary.textContent();
assert.match(automatic, /^\d+ of \d+ vertices, 0 of them said by hand\. 0 chosen\.$/);
assert.ok(await page.locator(".retype button.type").first().isDisabled(), "nothing is chosen yet");
await page.locator(".retype select").selectOption({ label: "handle" });
const handle = await page.evaluate(() => window.gfp.retype.chosen.size);
assert.ok(handle > 20);
await page.evaluate(() => window.gfp.world.aim());
await picture("retype");
await page.getByRole("button", { name: "Control", exact: true }).click();
await said.getByText(`${handle} changed`).waitFor();
assert.match(await summary.textContent(), new RegExp(`, ${handle} of them said by hand\\. 0 chosen`));
const dot = await page.evaluate(() => {
  const { world, retype } = window.gfp, box = world.canvas.getBoundingClientRect(), positions = retype.dots.geometry.getAttribute("position");
  const at = world.camera.position.clone().fromBufferAttribute(positions, 10).applyMatrix4(retype.dots.matrixWorld).project(world.camera);
  return [box.left + (0.5 + 0.5 * at.x) * box.width, box.top + (0.5 - 0.5 * at.y) * box.height];
});
await page.mouse.click(...dot);
assert.equal(await page.evaluate(() => window.gfp.retype.chosen.size), 1, "a click near a dot chooses one");
await page.getByRole("button", { name: "None", exact: true }).click();
await page.locator(".retype select").selectOption({ label: "handle" });
await page.getByRole("button", { name: "By itself", exact: true }).click();
await page.waitForFunction((before) => document.querySelector(".retype .summary").textContent === before, automatic);
await page.getByRole("button", { name: "Done", exact: true }).click();
assert.ok(await page.locator("#retype").isVisible());
await close();
