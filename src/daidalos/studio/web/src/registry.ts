// What extends the page, by name: the panels and displays of its own, and those that installed packages bring.
import { signal } from "@preact/signals";

export type Registered<T> = T & { readonly id: string };

export class Registry<T extends { readonly title?: string }> {
  /** Whether the packages' extensions are here as well, so that what is not here does not exist. */
  readonly isComplete = signal(false);
  private readonly entries = signal<ReadonlyMap<string, Registered<T>>>(new Map());

  /** `builtIn` are the modules of a folder, each of which exports one extension. */
  constructor(builtIn: Readonly<Record<string, Registered<T>>>) {
    for (const extension of Object.values(builtIn)) {
      this.add(extension);
    }
  }

  add(extension: Registered<T>): void {
    this.entries.value = new Map([...this.entries.peek(), [extension.id, extension]]);
  }

  find(id: string): Registered<T> | undefined {
    return this.entries.value.get(id);
  }

  /** All of them, by their titles. */
  get list(): readonly Registered<T>[] {
    const title = (each: Registered<T>) => each.title ?? each.id;
    return [...this.entries.value.values()].sort((a, b) => title(a).localeCompare(title(b)));
  }
}
