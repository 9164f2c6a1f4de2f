// A display that failed: draws nothing and reports the error.
import { signal } from "@preact/signals";
import { Group } from "three";
import type { Display, Status } from "../contract";

export class FailedDisplay implements Display {
  readonly object = new Group();
  readonly status;

  constructor(reason: string) {
    this.status = signal<Status>({ level: "error", text: reason });
  }

  restyle(): void {}

  update(): void {}

  dispose(): void {
    this.object.removeFromParent();
  }
}
