// The panels that were closed by the user, so that each can be opened again.
import { computed, signal, type ReadonlySignal } from "@preact/signals";
import type { DockviewApi } from "dockview-core";

const KEPT = 10;

export interface ClosedPanel {
  id: string;
  component: string;
  title: string;
  params: Record<string, unknown>;
}

interface Place {
  /** The other panels of its group, and which tab of it the panel was. */
  neighbours: readonly string[];
  index: number;
}

export class ClosedPanels {
  private readonly panels = signal<readonly (ClosedPanel & Place)[]>([]);
  private places = new Map<string, Place>();
  /** The panel that was closed last. */
  readonly last: ReadonlySignal<ClosedPanel | undefined> = computed(() => this.panels.value.at(-1));

  /** Remember what is closed while `isByUser`. */
  constructor(
    private readonly dock: DockviewApi,
    isByUser: () => boolean,
  ) {
    dock.onDidLayoutChange(() => this.notePlaces());
    dock.onDidRemovePanel(({ id, title, params, view }) => {
      if (isByUser()) {
        const place = this.places.get(id) ?? { neighbours: [], index: 0 };
        const closed = { id, title: title ?? "", component: view.contentComponent, params: params ?? {}, ...place };
        this.panels.value = [...this.panels.value, closed].slice(-KEPT);
      }
    });
  }

  private notePlaces(): void {
    this.places = new Map(
      this.dock.groups.flatMap(({ panels }) =>
        panels.map(({ id }, index) => [
          id,
          { neighbours: panels.map((each) => each.id).filter((each) => each !== id), index },
        ]),
      ),
    );
  }

  /** Return the panel that was closed last, which is then forgotten. */
  take(): (ClosedPanel & Place) | undefined {
    const last = this.panels.value.at(-1);
    this.panels.value = this.panels.value.slice(0, -1);
    return last;
  }

  /** Put a panel back among the tabs that it was among, where one of these is left. */
  open({ neighbours, index, ...panel }: ClosedPanel & Place): void {
    const present = this.dock.getPanel(panel.id);
    if (present) {
      present.api.setActive();
      return;
    }
    const referencePanel = neighbours.find((id) => this.dock.getPanel(id));
    this.dock.addPanel({ ...panel, ...(referencePanel === undefined ? {} : { position: { referencePanel, index } }) });
  }
}
