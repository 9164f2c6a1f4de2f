// The simulated world that is shown at present, for the panels beside it.
import { signal } from "@preact/signals";
import type { Editor } from "./editor";
import type { Simulator } from "./simulator";
import type { Stage } from "./stage";

export interface Room {
  simulator: Simulator;
  stage: Stage;
  editor: Editor;
}

/** The room of the Simulation panel; undefined while none is visible. */
export const openRoom = signal<Room | undefined>(undefined);
