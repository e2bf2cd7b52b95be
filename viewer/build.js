// Bundles the page into one compressed HTML document: node build.js MODULES_DIR OUTPUT
// Fetches its packages with `npm ci` where they are not there yet; where that fails, the page says that it was left out.
import { execFileSync } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const here = dirname(fileURLToPath(import.meta.url));
const [modulesDir, output] = process.argv.slice(2).map((path) => resolve(path));

function fetchPackages() {
  const stamp = join(modulesDir, "installed"), lock = join(here, "package-lock.json");
  if (existsSync(stamp) && statSync(stamp).mtimeMs >= statSync(lock).mtimeMs) return;
  mkdirSync(modulesDir, { recursive: true });
  for (const file of ["package.json", "package-lock.json"]) copyFileSync(join(here, file), join(modulesDir, file));
  execFileSync("npm", ["ci", "--no-audit", "--no-fund", "--ignore-scripts", "--prefer-offline", "--loglevel=error"], { cwd: modulesDir, stdio: ["ignore", "ignore", "inherit"] });
  writeFileSync(stamp, "");
}

async function bundle() {
  const esbuild = createRequire(join(modulesDir, "package.json"))("esbuild");
  const script = await esbuild.build({
    entryPoints: [join(here, "main.js")], bundle: true, minify: true, format: "iife", target: "es2022", write: false, legalComments: "none",
    nodePaths: [join(modulesDir, "node_modules")],
  });
  const style = (await esbuild.transform(readFileSync(join(here, "style.css"), "utf8"), { loader: "css", minify: true })).code;
  // Functions as replacements: text would have its `$` interpreted.
  return readFileSync(join(here, "index.html"), "utf8")
    .replace("/*STYLE*/", () => style)
    .replace("/*SCRIPT*/", () => script.outputFiles[0].text.replaceAll("</script", "<\\/script"));
}

let page;
try {
  fetchPackages();
  page = await bundle();
} catch (error) {
  if (existsSync(join(modulesDir, "installed"))) throw error; // a mistake of ours, not of the network
  console.log(`note: the view's page is left out: ${error.message}`);
  page = "<!doctype html><html lang=en><meta charset=utf-8><title>gfpd</title><p>This gfpd was built without its page, because npm could not fetch what it is made of. Foxglove's viewers can connect to this address.";
}
writeFileSync(output, gzipSync(page, { level: 9 }));
