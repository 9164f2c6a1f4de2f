// The frame that everything is drawn in: the one that was chosen, or the best there is.
import { computed, signal, type ReadonlySignal, type Signal } from "@preact/signals";
import { isString, stored } from "../app/stored";
import type { TransformBuffer } from "./buffer";

/** Take map when it exists, until then odom, until then the root of the largest tree. */
export const AUTOMATIC = "";
const PREFERRED = ["map", "odom"];

export class FixedFrame {
  readonly chosen: Signal<string>;
  readonly frames = signal<string[]>([]);
  readonly current: ReadonlySignal<string>;
  /** What the user should know about the choice; empty when all is well. */
  readonly remark: ReadonlySignal<string>;
  private structure = -1;

  /** A frame of the page's address holds for this window only; the user's choice is kept. */
  constructor(
    private readonly buffer: TransformBuffer,
    asked = AUTOMATIC,
  ) {
    this.chosen = asked === AUTOMATIC ? stored("fixedFrame", AUTOMATIC, isString) : signal(asked);
    this.current = computed(() => this.resolve());
    this.remark = computed(() => this.comment());
  }

  /** Look whether frames have come or gone; once per drawn frame. */
  refresh(): void {
    if (this.structure !== this.buffer.structure) {
      this.structure = this.buffer.structure;
      this.frames.value = this.buffer.frames().sort((a, b) => a.localeCompare(b));
    }
  }

  private resolve(): string {
    const frames = this.frames.value;
    if (this.chosen.value !== AUTOMATIC) {
      return this.chosen.value;
    }
    return PREFERRED.find((frame) => frames.includes(frame)) ?? this.buffer.mainRoot() ?? PREFERRED[0] ?? "map";
  }

  private comment(): string {
    const frames = this.frames.value;
    if (frames.length === 0) {
      return "no transforms yet";
    }
    if (this.chosen.value !== AUTOMATIC) {
      return frames.includes(this.chosen.value) ? "" : `${this.chosen.value} does not exist`;
    }
    return this.current.value === "map" ? "" : `no map frame yet: using ${this.current.value}`;
  }
}
