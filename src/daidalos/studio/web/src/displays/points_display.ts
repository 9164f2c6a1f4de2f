// The base of laser scans and point clouds: points of one measurement each, kept for the decay time.
import type { Stamped } from "../contract";
import { Box3 } from "three";
import { parseColor, TURBO } from "../scene/colors";
import { PointSprites } from "../scene/point_sprites";
import type { Property, Settings } from "../contract";
import { Display, place, type DisplayContext, type FrameInfo } from "./display";
import { frameOf, MessageFilter, stampOf } from "./message_filter";
import { number, text } from "./settings";

/** Where points are written: x y z and r g b, one after another. */
export interface PointWriter {
  positions: Float32Array;
  colors: Uint8Array;
}

interface Shot<M> {
  message: M;
  sprites: PointSprites;
  since: number;
  placedIn: string;
}

const KEEP = 4;

export abstract class PointsDisplay<M extends Stamped> extends Display {
  private readonly filter = new MessageFilter<M>();
  private readonly unsubscribe: () => void;
  private shots: Shot<M>[] = [];
  private spare: PointSprites[] = [];

  constructor(context: DisplayContext, settings: Settings) {
    super(context, settings);
    const topic = text(settings, "topic");
    this.report("idle", topic ? "no messages yet" : "no topic chosen");
    this.unsubscribe = topic
      ? context.session.subscribe<M>(topic, KEEP, (message) => this.filter.add(message, performance.now() / 1000))
      : () => undefined;
  }

  /** The maximum number of points of a message. */
  protected abstract capacity(message: M): number;
  /** Write a message's points and return how many there are. */
  protected abstract write(message: M, to: PointWriter): number;

  /** How many points are shown. */
  get pointCount(): number {
    return this.shots.reduce((sum, shot) => sum + shot.sprites.shown, 0);
  }

  override update(frame: FrameInfo): void {
    const decay = number(this.settings, "decay");
    for (const message of this.filter.take(this.context.tf, frame.fixed, frame.page)) {
      this.show(message, frame, decay);
    }
    this.forget(frame.page, decay);
    for (const shot of this.shots) {
      if (shot.placedIn !== frame.fixed) {
        this.put(shot, frame);
      }
    }
    if (this.filter.error) {
      this.report("error", this.filter.error);
    }
  }

  override bounds(): Box3 {
    const box = new Box3();
    for (const { sprites } of this.shots) {
      if (sprites.visible) {
        box.union(sprites.bounds());
      }
    }
    return box;
  }

  override restyle(settings: Settings): void {
    super.restyle(settings);
    for (const shot of this.shots) {
      this.fill(shot.sprites, shot.message);
    }
  }

  override dispose(): void {
    this.unsubscribe();
    for (const sprites of this.spare) {
      sprites.geometry.dispose();
      sprites.material.dispose();
    }
    super.dispose();
  }

  private show(message: M, frame: FrameInfo, decay: number): void {
    if (decay === 0) {
      for (const shot of this.shots.splice(0)) {
        this.retire(shot);
      }
    }
    const sprites = this.spare.pop() ?? new PointSprites();
    this.fill(sprites, message);
    this.object.add(sprites);
    const shot: Shot<M> = { message, sprites, since: frame.page, placedIn: "" };
    this.shots.push(shot);
    this.put(shot, frame);
    this.report("ok", `${sprites.shown} points in ${frameOf(message)}`);
    this.context.invalidate();
  }

  private fill(sprites: PointSprites, message: M): void {
    sprites.style = {
      metres: text(this.settings, "style") === "squares" ? number(this.settings, "metres") : 0,
      pixels: text(this.settings, "style") === "squares" ? 1 : number(this.settings, "pixels"),
      round: text(this.settings, "style") !== "squares",
      alpha: number(this.settings, "alpha"),
    };
    sprites.end(this.write(message, sprites.begin(this.capacity(message))));
  }

  private put(shot: Shot<M>, frame: FrameInfo): void {
    const moved = shot.placedIn !== "";
    const found = place(this.context, shot.sprites, frame.fixed, frameOf(shot.message), stampOf(shot.message), moved);
    shot.placedIn = found ? frame.fixed : shot.placedIn;
    shot.sprites.visible = found;
  }

  private forget(page: number, decay: number): void {
    while (this.shots.length > 1 && page - (this.shots[0] as Shot<M>).since > decay) {
      this.retire(this.shots.shift() as Shot<M>);
      this.context.invalidate();
    }
  }

  private retire(shot: Shot<M>): void {
    shot.sprites.removeFromParent();
    if (this.spare.length < 4) {
      this.spare.push(shot.sprites);
    } else {
      shot.sprites.geometry.dispose();
      shot.sprites.material.dispose();
    }
  }
}

/** Paints points by a value each, on a scale from the lowest to the highest value. */
export function paintByValue(values: ArrayLike<number>, count: number, colors: Uint8Array): void {
  let [lowest, highest] = [Infinity, -Infinity];
  for (let i = 0; i < count; i++) {
    const value = values[i] as number;
    lowest = value < lowest ? value : lowest;
    highest = value > highest ? value : highest;
  }
  const scale = highest > lowest ? 255 / (highest - lowest) : 0;
  for (let i = 0; i < count; i++) {
    const entry = 3 * Math.round(((values[i] as number) - lowest) * scale);
    colors[3 * i] = TURBO[entry] as number;
    colors[3 * i + 1] = TURBO[entry + 1] as number;
    colors[3 * i + 2] = TURBO[entry + 2] as number;
  }
}

export function paintFlat(hex: string, count: number, colors: Uint8Array): void {
  const [r, g, b] = parseColor(hex);
  for (let i = 0; i < 3 * count; i += 3) {
    colors[i] = r;
    colors[i + 1] = g;
    colors[i + 2] = b;
  }
}

export const POINT_PROPERTIES: readonly Property[] = [
  {
    key: "style",
    label: "Style",
    kind: "choice",
    options: [
      ["points", "Points"],
      ["squares", "Squares"],
    ],
  },
  {
    key: "pixels",
    label: "Size",
    kind: "number",
    min: 1,
    max: 30,
    step: 1,
    unit: "px",
    when: (settings) => settings.style === "points",
  },
  {
    key: "metres",
    label: "Size",
    kind: "number",
    min: 0.001,
    max: 1,
    step: 0.005,
    unit: "m",
    when: (settings) => settings.style === "squares",
  },
  { key: "alpha", label: "Alpha", kind: "number", min: 0, max: 1, step: 0.05 },
  { key: "decay", label: "Decay time", kind: "number", min: 0, max: 60, step: 0.5, unit: "s" },
];
