// The panels: adding one means a file beside this one, called <id>_panel.tsx.
import type { Panel } from "../contract";
import { Registry, type Registered } from "../registry";

export type RegisteredPanel = Registered<Panel>;

export const PANELS = new Registry<Panel>(
  import.meta.glob<RegisteredPanel>("./*_panel.tsx", { eager: true, import: "default" }),
);
