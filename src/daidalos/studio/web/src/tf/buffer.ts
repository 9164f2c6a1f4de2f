// The tree of coordinate frames over time: tf2's buffer, on this page's clock (seconds).
import { Quaternion, Vector3 } from "three";
import type { TransformStamped } from "../generated/geometry_msgs";
import { toSeconds } from "../ros/time";

/** How long transforms are kept, as tf2 does. */
const KEPT_S = 10;
/** A stamp this much older than the newest means that time was turned back. */
const RESET_S = 3;

/** A rigid transform: where a frame is, seen from another. */
export class Transform {
  readonly position = new Vector3();
  readonly rotation = new Quaternion();

  identity(): this {
    this.position.set(0, 0, 0);
    this.rotation.identity();
    return this;
  }

  copy(other: Transform): this {
    this.position.copy(other.position);
    this.rotation.copy(other.rotation);
    return this;
  }

  /** Become `outer * this`: what was seen from a frame is now seen from the outer one. */
  premultiply(outer: Transform): this {
    this.position.applyQuaternion(outer.rotation).add(outer.position);
    this.rotation.premultiply(outer.rotation);
    return this;
  }

  invert(): this {
    this.rotation.conjugate();
    this.position.applyQuaternion(this.rotation).negate();
    return this;
  }

  /** Rotation about the vertical, in rad. */
  get yaw(): number {
    const { x, y, z, w } = this.rotation;
    return Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
  }
}

interface Sample {
  time: number;
  transform: Transform;
}

interface Edge {
  parent: string;
  fixed: boolean;
  samples: Sample[];
  /** Smoothed time between two samples, in seconds; 0 until there were two. */
  period: number;
}

/** At a moment, or the newest there is. */
export type When = number | "latest";

export interface LookupOptions {
  /** Whether to use the nearest transform where none is known at the time. */
  clamp?: boolean;
}

export class TransformBuffer {
  private readonly edges = new Map<string, Edge>();
  private readonly roots = new Set<string>();
  /** Changes whenever frames come or go. */
  structure = 0;
  /** Called when stamps jump back, e.g. when a simulation is reset. */
  onReset: () => void = () => undefined;

  clear(): void {
    this.edges.clear();
    this.roots.clear();
    this.structure++;
  }

  set(message: TransformStamped, fixed: boolean): void {
    const child = plain(message.child_frame_id);
    const parent = plain(message.header.frame_id);
    if (!child || !parent || child === parent) {
      return;
    }
    const time = toSeconds(message.header.stamp);
    const edge = this.edgeFor(child, parent, fixed);
    const newest = edge.samples.at(-1);
    if (!fixed && newest && time < newest.time - RESET_S) {
      this.forgetMoving();
      this.onReset();
      this.set(message, fixed);
      return;
    }
    const transform = new Transform();
    const { translation, rotation } = message.transform;
    transform.position.set(translation.x, translation.y, translation.z);
    transform.rotation.set(rotation.x, rotation.y, rotation.z, rotation.w).normalize();
    if (fixed) {
      edge.samples = [{ time, transform }];
    } else {
      insert(edge, { time, transform });
    }
  }

  has(frame: string): boolean {
    return this.edges.has(frame) || this.roots.has(frame);
  }

  frames(): string[] {
    return [...this.roots, ...this.edges.keys()];
  }

  parentOf(frame: string): string | undefined {
    return this.edges.get(frame)?.parent;
  }

  rootOf(frame: string): string {
    let root = frame;
    for (let edge = this.edges.get(root), depth = 0; edge && depth < 1000; depth++) {
      root = edge.parent;
      edge = this.edges.get(root);
    }
    return root;
  }

  /** The root under which most frames hang; undefined while there is no frame. */
  mainRoot(): string | undefined {
    const sizes = new Map<string, number>();
    for (const frame of this.edges.keys()) {
      const root = this.rootOf(frame);
      sizes.set(root, (sizes.get(root) ?? 0) + 1);
    }
    return [...sizes].sort((a, b) => b[1] - a[1])[0]?.[0];
  }

  /** The stamp of the newest transform of a frame that moves. */
  newest(frame: string): number | undefined {
    const edge = this.edges.get(frame);
    return edge && !edge.fixed ? edge.samples.at(-1)?.time : undefined;
  }

  /** The frames that move, with their newest stamp and period. */
  *moving(): Iterable<{ frame: string; newest: number; period: number }> {
    for (const [frame, edge] of this.edges) {
      const last = edge.samples.at(-1);
      if (!edge.fixed && last) {
        yield { frame, newest: last.time, period: edge.period };
      }
    }
  }

  /** Find where `source` is, seen from `target`; on failure return false and leave `out` undefined. */
  lookup(target: string, source: string, when: When, out: Transform, options: LookupOptions = {}): boolean {
    const common = this.commonAncestor(target, source);
    return (
      common !== undefined &&
      this.climb(source, common, when, options, out) &&
      this.climb(target, common, when, options, INVERSE) &&
      (out.premultiply(INVERSE.invert()), true)
    );
  }

  /** Explain why `lookup` fails. */
  explain(target: string, source: string, when: When): string {
    for (const frame of [target, source]) {
      if (!this.has(frame)) {
        return `frame ${frame || "(empty)"} does not exist`;
      }
    }
    if (this.commonAncestor(target, source) === undefined) {
      return `${source} and ${target} are not connected`;
    }
    return when === "latest" ? "no transform" : `no transform from ${source} to ${target} at this time`;
  }

  private commonAncestor(a: string, b: string): string | undefined {
    const seen = new Set<string>();
    for (let at: string | undefined = a; at !== undefined && !seen.has(at); at = this.parentOf(at)) {
      seen.add(at);
    }
    for (let at: string | undefined = b, depth = 0; at !== undefined && depth < 1000; at = this.parentOf(at), depth++) {
      if (seen.has(at)) {
        return at;
      }
    }
    return undefined;
  }

  /** Find where a frame is, seen from one of its ancestors. */
  private climb(frame: string, ancestor: string, when: When, options: LookupOptions, out: Transform): boolean {
    out.identity();
    for (let at = frame; at !== ancestor;) {
      const edge = this.edges.get(at);
      if (!edge || !sampleAt(edge, when, options.clamp ?? false, STEP)) {
        return false;
      }
      out.premultiply(STEP);
      at = edge.parent;
    }
    return true;
  }

  private edgeFor(child: string, parent: string, fixed: boolean): Edge {
    const known = this.edges.get(child);
    if (known && known.parent === parent && known.fixed === fixed) {
      return known;
    }
    const edge: Edge = { parent, fixed, samples: [], period: 0 };
    this.edges.set(child, edge);
    this.roots.clear();
    for (const { parent: above } of this.edges.values()) {
      if (!this.edges.has(above)) {
        this.roots.add(above);
      }
    }
    this.structure++;
    return edge;
  }

  private forgetMoving(): void {
    for (const edge of this.edges.values()) {
      if (!edge.fixed) {
        edge.samples = [];
      }
    }
  }
}

const STEP = new Transform();
const INVERSE = new Transform();

/** Names of ROS 1 may start with a slash; tf2 drops it. */
function plain(frame: string): string {
  return frame.startsWith("/") ? frame.slice(1) : frame;
}

function insert(edge: Edge, sample: Sample): void {
  const { samples } = edge;
  const newest = samples.at(-1);
  if (!newest || sample.time > newest.time) {
    if (newest) {
      const gap = sample.time - newest.time;
      edge.period = edge.period ? edge.period + 0.1 * (gap - edge.period) : gap;
    }
    samples.push(sample);
    prune(samples, sample.time - KEPT_S);
  } else {
    const at = after(samples, sample.time);
    if (samples[at - 1]?.time === sample.time) {
      samples[at - 1] = sample;
    } else {
      samples.splice(at, 0, sample);
    }
  }
}

/** Drop what is too old, many at a time: moving an array for each new sample would cost more. */
function prune(samples: Sample[], oldest: number): void {
  if (samples.length > 64 && (samples[samples.length >> 1]?.time ?? Infinity) < oldest) {
    samples.splice(0, after(samples, oldest) - 1);
  }
}

/** The index of the first sample later than a time. */
function after(samples: Sample[], time: number): number {
  let [low, high] = [0, samples.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((samples[middle] as Sample).time <= time) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

function sampleAt(edge: Edge, when: When, clamp: boolean, out: Transform): boolean {
  const { samples } = edge;
  const newest = samples.at(-1);
  if (!newest) {
    return false;
  }
  if (edge.fixed || when === "latest") {
    out.copy(newest.transform);
    return true;
  }
  const at = after(samples, when);
  const before = samples[at - 1];
  const next = samples[at];
  if (before && next) {
    const share = (when - before.time) / (next.time - before.time);
    out.position.lerpVectors(before.transform.position, next.transform.position, share);
    out.rotation.slerpQuaternions(before.transform.rotation, next.transform.rotation, share);
    return true;
  }
  const nearest = before ?? next;
  if (nearest && (clamp || nearest.time === when)) {
    out.copy(nearest.transform);
    return true;
  }
  return false;
}
