// What can be taken back, newest last.
import { computed, signal } from "@preact/signals";

const MAX_STEPS = 100;

interface Deed {
  /** Of the model. */
  name: string;
  what: string;
  undo: () => Promise<unknown>;
}

export class Undoing {
  private readonly deeds = signal<readonly Deed[]>([]);
  /** What would be taken back next, in words; empty: nothing. */
  readonly next = computed(() => {
    const last = this.deeds.value.at(-1);
    return last ? `${last.what} ${last.name}` : "";
  });

  note(name: string, what: string, undo: () => Promise<unknown>): void {
    this.deeds.value = [...this.deeds.value.slice(1 - MAX_STEPS), { name, what, undo }];
  }

  take(): Deed | undefined {
    const last = this.deeds.value.at(-1);
    this.deeds.value = this.deeds.value.slice(0, -1);
    return last;
  }
}
