"""The page of a gfpd, from outside its container: page.py URL. An error where it is not the bundled one."""
import gzip
import sys
import urllib.request

with urllib.request.urlopen(sys.argv[1], timeout=10) as answer:
    body = answer.read()
    assert answer.status == 200, f"HTTP {answer.status}, expected 200"
    page = gzip.decompress(body) if answer.headers["Content-Encoding"] == "gzip" else body
script = page[page.index(b"<script>"):page.index(b"</script>")]
assert len(script) > 100_000 and b"WebSocket" in script, f"the page's script has {len(script)} bytes and is not the bundled one"
print(f"page: HTTP 200, {len(body)} bytes compressed, {len(script)} bytes of script")
