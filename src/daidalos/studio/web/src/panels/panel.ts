// How the page's own panels are written: a Preact component for what the contract calls mount.
import type { ReadonlySignal } from "@preact/signals";
import { type ComponentType, h, render } from "preact";
import type { Studio } from "../app/studio";
import type { Panel, PanelContext } from "../contract";
import type { Registered } from "../registry";
import type { IconName } from "../ui/icons";

export interface PanelProps extends PanelContext {
  readonly studio: Studio;
  readonly visible: ReadonlySignal<boolean>;
}

export interface BuiltInPanel extends Registered<Panel> {
  readonly icon: IconName;
  /** The panel beside it where it is a window of its own, and how wide that one is. */
  readonly beside?: readonly [panel: string, width: number];
}

/** Mount a component; the page's context is more than the contract's. */
export function withPreact(component: ComponentType<PanelProps>): Panel["mount"] {
  return (element, context) => {
    render(h(component, context as PanelProps), element);
    return () => render(null, element);
  };
}
