#!/usr/bin/env bash
# Builds docker/Dockerfile with buildah and runs it with podman, as root, on a base that debootstrap makes; then a subscriber on this
# host, outside the container, must get objects with closed meshes from the demo inside it, and the page of the view.
#   container_test.sh GFP PYTHON3     exit code 77: skipped, with the reason
# Kept between runs in $GFP_CONTAINER_DIR (default ~/.cache/gfp/container): the base and the layers. The host's ccache serves the build.
set -euo pipefail
cd "$(dirname "$0")/../.."
gfp=$1 python3=$2
skip() { echo "skipped: $1"; exit 77; }
for tool in buildah podman runc debootstrap; do command -v "$tool" >/dev/null || skip "$tool is not installed"; done
[ "$(id -u)" = 0 ] || skip "chroot isolation needs root"

dir=${GFP_CONTAINER_DIR:-$HOME/.cache/gfp/container}
ccache=${CCACHE_DIR:-$HOME/.cache/ccache}
mkdir -p "$dir" "$ccache"
store=(--root "$dir/storage" --runroot "$dir/run" --storage-driver vfs)
base=localhost/gfp-debian:bookworm-slim
if ! podman "${store[@]}" image exists "$base"; then
  [ -e "$dir/rootfs/etc/debian_version" ] || debootstrap --variant=minbase bookworm "$dir/rootfs" http://deb.debian.org/debian
  # What Debian's own slim image leaves out.
  tar -C "$dir/rootfs" --exclude='./usr/share/doc/*' --exclude='./usr/share/man/*' --exclude='./usr/share/locale/*' \
      --exclude='./var/cache/apt/*' --exclude='./var/lib/apt/lists/*' -c . | podman "${store[@]}" import - "$base"
fi

# npm gets this host's certificates: it may be behind a proxy.
authorities=/etc/ssl/certs/ca-certificates.crt
build() {
  buildah "${store[@]}" bud --layers --format docker --isolation chroot --network host --pull-never --build-arg BASE="$base" \
    -v "$authorities:/run/authorities.crt:ro" --build-arg NODE_EXTRA_CA_CERTS=/run/authorities.crt -v "$ccache:/root/.cache/ccache" --target "$1" -t "localhost/$2" -f docker/Dockerfile .
}
build service gfp:test
build subscriber gfp-subscriber:test

fail() { echo "FAILED: $1" >&2; exit 1; }
size_mb=$(($(podman "${store[@]}" image inspect --format '{{.Size}}' localhost/gfp:test) / 1000000))
echo "runtime image: $size_mb MB"
[ "$size_mb" -le 550 ] || fail "the runtime image has $size_mb MB, at most 550 are wanted"

sockets=$(mktemp -d)
chown 10001:10001 "$sockets"
run=(podman "${store[@]}" --runtime /usr/sbin/runc --cgroup-manager cgroupfs)
limits=(--ulimit nofile=1024:1024 --ulimit nproc=1000:1000 --cap-drop ALL --read-only -v "$sockets:/run/gfp")
name=gfp-test-$$
end() { "${run[@]}" rm -f "$name" "$name-example" >/dev/null 2>&1 || true; rm -rf "$sockets"; }
trap end EXIT
port=$("$python3" -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
"${run[@]}" run -d --name "$name" --network host "${limits[@]}" localhost/gfp:test --config /etc/gfp/demo.yaml --set "view.port=$port" >/dev/null

export RUNTIME_DIRECTORY="$sockets"
PYTHONPATH=clients/python PYTHONDONTWRITEBYTECODE=1 "$python3" tests/docker/subscribe.py || { "${run[@]}" logs "$name"; fail "no objects came out of the container"; }
"$gfp" sub /gfp/scene/ --count 3 --seconds 60 --json >/dev/null || fail "gfp sub outside the container saw nothing"
"$python3" tests/docker/page.py "http://127.0.0.1:$port/" || fail "the container serves no page"
[ "$("${run[@]}" exec "$name" id -u)" = 10001 ] || fail "the service runs as another user than 10001"
"${run[@]}" exec "$name" gfp echo /gfp/status/gfpd/ --count 1 --seconds 5 >/dev/null || fail "the health check fails while the daemon publishes"
"${run[@]}" run -d --name "$name-example" --network none "${limits[@]}" localhost/gfp-subscriber:test >/dev/null
for ((tries = 0; tries < 60; ++tries)); do
  grep -q triangles <<<"$("${run[@]}" logs "$name-example" 2>&1)" && break
  sleep 0.5
done
grep -q triangles <<<"$("${run[@]}" logs "$name-example" 2>&1)" || fail "the example subscriber in its own container saw no mesh"
"${run[@]}" stop -t 10 "$name-example" >/dev/null
code=$("${run[@]}" inspect --format '{{.State.ExitCode}}' "$name-example")
[ "$code" = 0 ] || fail "the image's stop signal ended the example subscriber with $code, expected 0 (137: it had to be killed)"

"${run[@]}" stop -t 10 "$name" >/dev/null
code=$("${run[@]}" inspect --format '{{.State.ExitCode}}' "$name")
[ "$code" = 0 ] || fail "SIGTERM ended the daemon with $code, expected 0"
if "$gfp" echo /gfp/status/gfpd/ --count 1 --seconds 2 >/dev/null; then fail "the health check passes without a daemon"; fi
echo "ok"
