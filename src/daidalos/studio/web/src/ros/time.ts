// ROS stamps as seconds: a double holds today's stamps to a quarter of a microsecond.
import type { Time } from "../generated/builtin_interfaces";

export function toSeconds(stamp: Time): number {
  return stamp.sec + stamp.nanosec * 1e-9;
}

export function toStamp(seconds: number): Time {
  const sec = Math.floor(seconds);
  const nanosec = Math.round((seconds - sec) * 1e9);
  return nanosec === 1_000_000_000 ? { sec: sec + 1, nanosec: 0 } : { sec, nanosec };
}

/** Robot time as people read it: a date for wall clocks, hours and minutes for simulations. */
export function formatTime(seconds: number): string {
  if (seconds > 1e8) {
    return new Date(seconds * 1000).toLocaleTimeString([], { hour12: false });
  }
  const whole = Math.floor(seconds);
  const tenths = Math.floor((seconds - whole) * 10);
  const [h, m, s] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60, whole % 60];
  const two = (n: number) => String(n).padStart(2, "0");
  return `${h ? `${h}:${two(m)}` : m}:${two(s)}.${tenths}`;
}
