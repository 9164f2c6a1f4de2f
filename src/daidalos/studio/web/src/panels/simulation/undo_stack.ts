// Stack of the steps that can be undone, newest last.
import { computed, signal } from "@preact/signals";

const MAX_STEPS = 100;

interface Step {
  /** Of the model. */
  name: string;
  what: string;
  undo: () => Promise<unknown>;
}

export class UndoStack {
  private readonly steps = signal<readonly Step[]>([]);
  /** The step that would be undone next, in words; empty for none. */
  readonly next = computed(() => {
    const last = this.steps.value.at(-1);
    return last ? `${last.what} ${last.name}` : "";
  });

  push(name: string, what: string, undo: () => Promise<unknown>): void {
    this.steps.value = [...this.steps.value.slice(1 - MAX_STEPS), { name, what, undo }];
  }

  pop(): Step | undefined {
    const last = this.steps.value.at(-1);
    this.steps.value = this.steps.value.slice(0, -1);
    return last;
  }
}
