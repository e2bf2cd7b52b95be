// The page in a real browser: what it shows is what the daemon publishes, by mouse and by keyboard, on a laptop and on a tablet.
//   node browser_test.mjs PORT PICTURES_DIR      leaves its screenshots there, for eyes
import assert from "node:assert/strict";
import { mkdirSync, mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const [port, pictures] = process.argv.slice(2);
mkdirSync(pictures, { recursive: true });
const FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const context = await chromium.launchPersistentContext(mkdtempSync(join(tmpdir(), "gfp-browser-")), { executablePath: "/usr/bin/chromium", args: FLAGS, viewport: { width: 1280, height: 800 } });
context.setDefaultTimeout(120_000); // a busy machine without a graphics card; every wait ends with what it waits for
const page = context.pages()[0] ?? (await context.newPage());
const errors = [];
page.on("pageerror", (error) => errors.push(String(error)));
page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
const foreign = [];
page.on("request", (request) => !request.url().startsWith(`http://127.0.0.1:${port}/`) && !request.url().startsWith("data:") && foreign.push(request.url()));

/** Waits until a picture was drawn after now. */
const drawn = () => page.evaluate(() => { const { world } = window.gfp; const before = world.pictures; world.draw(); return new Promise((resolve) => { const look = () => (world.pictures > before ? resolve() : setTimeout(look, 20)); look(); }); });
const picture = async (name) => { await drawn(); await page.screenshot({ path: join(pictures, `${name}.png`) }); };
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

await page.goto(`http://127.0.0.1:${port}/`);
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
assert.deepEqual(errors, []);
assert.deepEqual(foreign, [], "the page asks others");
await context.close();
console.log("ok");
