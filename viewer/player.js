// The player bar of a replay: play and pause, where, how fast. Shown only where a recording is played.
const $ = (id) => document.getElementById(id);
const JUMP_ns = 1_000_000_000n, FRAME_ns = 33_400_000n; // a frame back: the first one from a thirtieth of a second before

function clock(ns) {
  const tenths = Number(ns / 100_000_000n);
  return `${Math.floor(tenths / 600)}:${String(Math.floor(tenths / 10) % 60).padStart(2, "0")}.${tenths % 10}`;
}

export class Player {
  /** `steer(request)` as the Connection's. */
  constructor(steer) {
    this.steer = steer;
    this.playback = null;
    this.scrub = $("scrub");
    $("play").addEventListener("click", () => this.toggle());
    $("speed").addEventListener("change", ({ target }) => steer({ speed: Number(target.value) }));
    this.scrub.addEventListener("input", () => this.seek(this.playback.begin_ns + BigInt(this.scrub.value) * 1_000_000n));
    for (const kind of ["pointerdown", "pointerup", "pointercancel"]) this.scrub.addEventListener(kind, () => (this.isHeld = kind === "pointerdown"));
  }

  get isActive() {
    return this.playback !== null;
  }

  show(playback) {
    this.playback = playback;
    $("player").hidden = playback === null;
    if (!playback) return;
    const { begin_ns, end_ns, now_ns, status, speed } = playback;
    const isPlaying = status === "playing" || status === "buffering";
    $("play").textContent = isPlaying ? "❚❚" : status === "ended" ? "↻" : "▶";
    $("play").setAttribute("aria-label", isPlaying ? "Pause the replay" : status === "ended" ? "Play again" : "Play");
    this.scrub.max = String((end_ns - begin_ns) / 1_000_000n);
    if (!this.isHeld) this.scrub.value = String((now_ns - begin_ns) / 1_000_000n); // not from under a finger
    this.scrub.setAttribute("aria-valuetext", `${clock(now_ns - begin_ns)} of ${clock(end_ns - begin_ns)}`);
    $("played").textContent = `${clock(now_ns - begin_ns)} / ${clock(end_ns - begin_ns)}`;
    const choice = [...$("speed").options].find(({ value }) => Number(value) === Math.fround(speed) || Math.abs(Number(value) - speed) < 1e-6);
    $("speed").value = choice?.value ?? "";
  }

  toggle() {
    const { status, begin_ns } = this.playback;
    if (status === "ended") this.steer({ play: true, seek_ns: begin_ns });
    else this.steer({ play: status === "paused" });
  }

  seek(to_ns, more = {}) {
    const { begin_ns, end_ns } = this.playback;
    this.playback.now_ns = to_ns < begin_ns ? begin_ns : to_ns > end_ns ? end_ns : to_ns; // at once: the next jump counts from here
    this.steer({ ...more, seek_ns: this.playback.now_ns });
    this.show(this.playback);
  }

  jump(direction) {
    this.seek(this.playback.now_ns + BigInt(direction) * JUMP_ns);
  }

  /** The next frame (the first one later than this), or one before it; paused, so that one sees it. */
  step(direction) {
    this.seek(this.playback.now_ns + (direction > 0 ? 1n : -FRAME_ns), { play: false });
  }
}
