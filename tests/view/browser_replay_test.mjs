// The page of a gfpd that plays a recording: the player bar by mouse and by keyboard.   node browser_replay_test.mjs PORT PICTURES_DIR
import assert from "node:assert/strict";
import { openPage } from "./browser.mjs";

const [port, pictures] = process.argv.slice(2);
const { page, picture, close } = await openPage(port, pictures);
const state = () => page.evaluate(() => { const { status, speed, now_ns, begin_ns, end_ns } = window.gfp.player.playback; return { status, speed, at: Number(now_ns - begin_ns) / Number(end_ns - begin_ns), at_ns: Number(now_ns - begin_ns) }; });
const until = (status) => page.waitForFunction((wanted) => window.gfp.player.playback?.status === wanted, status);
const sequence = () => page.evaluate(() => Number(window.gfp.state.scene.header.sequence));

await page.waitForFunction(() => window.gfp?.player.playback && window.gfp.state.scene?.objects.length >= 2);
assert.ok(await page.locator("#player").isVisible() && await page.locator("#pause").isHidden());
assert.ok(await page.locator("#compare").isHidden(), "a choice of methods where there is one");
assert.equal(await page.locator("#connection").textContent(), "replay");
await until("ended"); // four seconds of it
assert.match(await page.locator("#played").textContent(), /^0:0(\d\.\d) \/ 0:0\1$/);
assert.equal(await page.locator("#play").getAttribute("aria-label"), "Play again");

// A place by the mouse: what stands there is shown, and it stays there.
const before = await sequence();
const bar = await page.locator("#scrub").boundingBox();
await page.mouse.click(bar.x + bar.width / 2, bar.y + bar.height / 2);
await until("paused");
await page.waitForFunction((last) => Number(window.gfp.state.scene.header.sequence) > last, before);
assert.ok(Math.abs((await state()).at - 0.5) < 0.1, `a click into the middle led to ${(await state()).at}`);
await page.evaluate(() => window.gfp.world.aim());
await picture("replay_paused");

// Two sensors were recorded: the other one's picture of the same objects, which stands at the same place of the recording.
const shown = () => page.evaluate(() => { const { sensor, scene } = window.gfp.state; return { sensor, ids: scene.objects.map(({ id }) => Number(id)).sort() }; });
const first = await shown();
await page.keyboard.press("v");
await page.waitForFunction((before) => { const { state, world } = window.gfp; return state.sensor !== before && state.scene.header.sensor === state.sensor && world.cloud.points.visible; }, first.sensor);
assert.deepEqual((await shown()).ids, first.ids, "one object has two ids");
assert.equal((await state()).status, "paused");
await picture("replay_other_sensor");
await page.locator("#sensor-choice button", { hasText: first.sensor }).click();
await page.waitForFunction((before) => window.gfp.state.scene.header.sensor === before, first.sensor);

// A frame on and back, a second on, by the keyboard.
await page.locator("#canvas").focus();
const here = await state();
await page.keyboard.press(".");
await page.waitForFunction((at) => Number(window.gfp.player.playback.now_ns - window.gfp.player.playback.begin_ns) > at + 10_000_000, here.at_ns);
await page.keyboard.press("Shift+ArrowRight");
await page.waitForFunction((at) => Number(window.gfp.player.playback.now_ns - window.gfp.player.playback.begin_ns) > at + 900_000_000, here.at_ns);
await page.keyboard.press("Shift+ArrowLeft");
await page.keyboard.press("Shift+ArrowLeft");
await page.waitForFunction((at) => Number(window.gfp.player.playback.now_ns - window.gfp.player.playback.begin_ns) < at, here.at_ns);
assert.equal((await state()).status, "paused");

// Its speed; then on to the end by the space bar, and from the end to the beginning.
await page.locator("#speed").selectOption("2");
await page.waitForFunction(() => window.gfp.player.playback.speed === 2);
await page.locator("#canvas").focus();
await page.keyboard.press(" ");
await until("playing");
await until("ended");
await page.keyboard.press(" ");
await until("playing");
await page.waitForFunction(() => { const { now_ns, begin_ns, end_ns } = window.gfp.player.playback; return now_ns - begin_ns < (end_ns - begin_ns) / 2n; });
await page.keyboard.press(" ");
await until("paused");

// The slider under the keyboard's focus has its own keys.
await page.locator("#scrub").focus();
await page.keyboard.press("End");
await page.waitForFunction(() => { const { now_ns, end_ns } = window.gfp.player.playback; return end_ns - now_ns < 300_000_000n; });
await page.setViewportSize({ width: 768, height: 1024 });
await picture("replay_tablet");
assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "the page is wider than the tablet");
await close();
