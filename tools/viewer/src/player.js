/** Which frame is shown, and going on by the clock. */
export class Player {
  constructor(list, show) {
    this.list = list;
    this.show = show;  // (number) => Promise
    this.rate = 1;  // seconds of the scene shown in a second
    this.frame = 0;
    this.playing = false;
    this.time = list[0].time;
    this.onState = () => {};
  }

  get last() {
    return this.list.length - 1;
  }

  /** Shows a frame; a later call overtakes an earlier one that is still being unpacked. */
  async seek(number) {
    this.frame = Math.min(Math.max(number, 0), this.last);
    this.time = this.list[this.frame].time;
    this.onState();
    await this.show(this.frame);
  }

  toggle(playing = !this.playing) {
    if (this.playing === playing || this.last === 0) return;
    this.playing = playing;
    this.onState();
    if (!playing) return;
    if (this.frame === this.last) this.time = this.list[0].time;
    this.previous = undefined;
    requestAnimationFrame((now) => this.tick(now));
  }

  async tick(now) {
    if (!this.playing) return;
    const elapsed = Math.min((now - (this.previous ?? now)) / 1000, 0.5);
    this.previous = now;
    const end = this.list[this.last].time;
    this.time += elapsed * this.rate;
    if (this.time > end + this.pause()) this.time = this.list[0].time;  // and round again
    const number = this.at(Math.min(this.time, end));
    if (number !== this.frame) {
      this.frame = number;
      this.onState();
      await this.show(number);
    }
    requestAnimationFrame((later) => this.tick(later));
  }

  /** How long the last frame stays (s of the scene). */
  pause() {
    return 0.6 * this.rate;
  }

  /** The last frame that is not after a time. */
  at(time) {
    let low = 0, high = this.last;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.list[middle].time <= time + 1e-9) low = middle;
      else high = middle - 1;
    }
    return low;
  }
}
