// The page in Debian's chromium, for tests: errors of the page, and requests to anybody but gfpd, are failures.
import assert from "node:assert/strict";
import { mkdirSync, mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

export async function openPage(port, pictures) {
  mkdirSync(pictures, { recursive: true });
  const context = await chromium.launchPersistentContext(mkdtempSync(join(tmpdir(), "gfp-browser-")), { executablePath: "/usr/bin/chromium", args: FLAGS, viewport: { width: 1280, height: 800 } });
  context.setDefaultTimeout(120_000); // a busy machine without a graphics card; every wait ends with what it waits for
  const page = context.pages()[0] ?? (await context.newPage());
  const errors = [], foreign = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  page.on("request", (request) => !request.url().startsWith(`http://127.0.0.1:${port}/`) && !request.url().startsWith("data:") && foreign.push(request.url()));
  await page.goto(`http://127.0.0.1:${port}/`);

  /** Waits until a picture was drawn after now. */
  const drawn = () => page.evaluate(() => { const { world } = window.gfp; const before = world.pictures; world.draw(); return new Promise((resolve) => { const look = () => (world.pictures > before ? resolve() : setTimeout(look, 20)); look(); }); });
  const picture = async (name) => { await drawn(); await page.screenshot({ path: join(pictures, `${name}.png`) }); };
  const close = async () => {
    assert.deepEqual(errors, []);
    assert.deepEqual(foreign, [], "the page asks others");
    await context.close();
    console.log("ok");
  };
  return { page, drawn, picture, close };
}
