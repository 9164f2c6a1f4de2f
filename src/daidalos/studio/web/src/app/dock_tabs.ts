// Tabs of the dock for keyboards and screen readers, by the ARIA pattern of tabs.
//
// Arrow keys, Home and End go to another tab of the group and show its panel, Enter and Space show it, Delete closes it.
import type { DockviewApi, IDockviewPanel } from "dockview-core";

const TAB = ".dv-tab";
const LIST = ".dv-tabs-container";

/** Describe the tabs below an element, now and whenever they change, and listen to keys. */
export function describeTabs(element: HTMLElement, dock: DockviewApi): void {
  let isAsked = false;
  const describeSoon = () => {
    if (!isAsked) {
      isAsked = true;
      queueMicrotask(() => {
        isAsked = false;
        describe(element, dock);
      });
    }
  };
  dock.onDidLayoutChange(describeSoon);
  dock.onDidActivePanelChange(describeSoon);
  new MutationObserver(describeSoon).observe(element, {
    subtree: true,
    childList: true,
    attributeFilter: ["class"],
  });
  element.addEventListener("keydown", (event) => onKey(event, element, dock));
  describe(element, dock);
}

function describe(element: HTMLElement, dock: DockviewApi): void {
  for (const group of dock.groups) {
    const list = group.element.querySelector<HTMLElement>(LIST);
    if (!list) {
      continue;
    }
    set(list, { role: "tablist", "aria-label": "Panels" });
    const content = group.element.querySelector<HTMLElement>(".dv-content-container");
    [...list.querySelectorAll<HTMLElement>(TAB)].forEach((tab, index) => {
      const panel = group.panels[index];
      if (!panel) {
        return;
      }
      const isShown = panel === group.activePanel;
      set(tab, { role: "tab", id: `tab-${panel.id}`, "aria-selected": `${isShown}`, tabindex: isShown ? "0" : "-1" });
      const close = tab.querySelector<HTMLElement>(".dv-default-tab-action");
      if (close) {
        // For the mouse; the keyboard has Delete, as a tab may not hold another control.
        set(close, { "aria-hidden": "true", title: `Close ${panel.title ?? ""} (Delete)` });
      }
      if (isShown && content) {
        set(content, { role: "tabpanel", "aria-labelledby": `tab-${panel.id}` });
      }
    });
  }
  element.querySelectorAll(".dv-tabs-overflow-dropdown-root").forEach((more) => set(more, { title: "More panels" }));
}

function set(element: Element, attributes: Record<string, string>): void {
  for (const [name, value] of Object.entries(attributes)) {
    if (element.getAttribute(name) !== value) {
      element.setAttribute(name, value);
    }
  }
}

function onKey(event: KeyboardEvent, element: HTMLElement, dock: DockviewApi): void {
  const tab = event.target instanceof HTMLElement && event.target.matches(TAB) ? event.target : undefined;
  const group = tab && dock.groups.find((each) => each.element.contains(tab));
  const index = group?.panels.findIndex(({ id }) => tab?.id === `tab-${id}`) ?? -1;
  if (!group || index < 0 || event.ctrlKey || event.altKey || event.metaKey) {
    return;
  }
  const { panels } = group;
  const shown = destination(event.key, index, panels);
  if (shown) {
    shown.api.setActive();
  } else if (event.key === "Delete") {
    panels[index]?.api.close();
  } else {
    return;
  }
  event.preventDefault();
  event.stopPropagation(); // these keys are no shortcuts of the page here
  const now = shown ?? dock.activePanel;
  queueMicrotask(() => element.querySelector<HTMLElement>(`[id="tab-${now?.id}"]`)?.focus());
}

/** The panel that a key shows, pressed on the tab at an index; undefined: none. */
function destination(key: string, index: number, panels: readonly IDockviewPanel[]): IDockviewPanel | undefined {
  const count = panels.length;
  switch (key) {
    case "ArrowRight":
      return panels[(index + 1) % count];
    case "ArrowLeft":
      return panels[(index + count - 1) % count];
    case "Home":
      return panels[0];
    case "End":
      return panels[count - 1];
    case "Enter":
    case " ":
      return panels[index];
    default:
      return undefined;
  }
}
