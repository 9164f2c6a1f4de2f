// The contract of a panel: a part of the page that can be docked anywhere.
import type { ReadonlySignal } from "@preact/signals";
import type { ComponentType } from "preact";
import type { Studio } from "../app/studio";
import type { IconName } from "../ui/icons";

export interface PanelProps {
  studio: Studio;
  /** Whether the panel is on the screen; hidden ones should cost nothing. */
  visible: ReadonlySignal<boolean>;
  /** What the panel remembers, kept with the layout. */
  params: Readonly<Record<string, unknown>>;
  remember(params: Record<string, unknown>): void;
}

export interface PanelType {
  readonly id: string;
  readonly title: string;
  readonly icon: IconName;
  /** Whether there may be several. */
  readonly many?: boolean;
  readonly component: ComponentType<PanelProps>;
}
