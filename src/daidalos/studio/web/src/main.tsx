// Entry: builds the application and puts it into the page.
import { signal } from "@preact/signals";
import { render } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import "dockview-core/dist/styles/dockview.css";
import "uplot/dist/uPlot.min.css";
import "./styles/theme.css";
import "./styles/shell.css";
import "./styles/controls.css";
import { fetchArrangement } from "./app/arrangement";
import { Help } from "./app/help";
import { Layout } from "./app/layout";
import { asksForMore, readFront, readOpening } from "./app/opening";
import { listenToKeys } from "./app/shortcuts";
import { Studio } from "./app/studio";
import { attachedWorld, installTestHooks } from "./app/test_hooks";
import { TopBar } from "./app/top_bar";
import { loadExtensions } from "./extensions";
import { PANELS } from "./panels/registry";

const layout = signal<Layout | undefined>(undefined);
/** How long closing a panel can be undone by a button [ms]; the menu of panels can do it later as well. */
const UNDO_MS = 8000;
const needsExtensions = asksForMore(location.search, PANELS);
if (needsExtensions) {
  await loadExtensions();
}
const opening = readOpening(location.search, PANELS);

function App({ studio }: { studio: Studio }) {
  const dock = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const made = new Layout(dock.current as HTMLDivElement, studio, opening, readFront(location.search, PANELS));
    studio.openPanel = (id, params, direction) => made.openById(id, params, direction);
    layout.value = made;
  }, []);
  return (
    <>
      <TopBar studio={studio} layout={layout} />
      <main class="dock" ref={dock} />
      <Closed />
      <Lost studio={studio} />
      <Help />
    </>
  );
}

/** A message for a while after a panel was closed, with how to undo that. */
function Closed() {
  const closed = layout.value?.lastClosed;
  const [dismissed, dismiss] = useState<unknown>(undefined);
  useEffect(() => {
    const timer = setTimeout(() => dismiss(closed), UNDO_MS);
    return () => clearTimeout(timer);
  }, [closed]);
  return closed && closed !== dismissed ? (
    <div class="closed" role="status" data-test="closed">
      <span>“{closed.title}” was closed</span>
      <button class="button" onClick={() => layout.value?.reopen()}>
        Undo
      </button>
    </div>
  ) : null;
}

const LOST = {
  lost: ["Connection lost.", "The program that serves this page has ended or cannot be reached; trying again…"],
  silent: ["The server is silent.", "It has said nothing for 3 s; what is shown here is old."],
} as const;

/** A message over all panels while the connection is lost, or nothing comes over it. */
function Lost({ studio }: { studio: Studio }) {
  const state = studio.session.link.value;
  if (state !== "lost" && state !== "silent") {
    return null;
  }
  const [what, more] = LOST[state];
  return (
    <div class="lost" role="alert" data-test={state}>
      <span class="spinner" />
      <span>
        <strong>{what}</strong> {more}
      </span>
    </div>
  );
}

/** The server that sent the page, unless the address names another: ?connect=ws://robot:8765 */
function serverUrl(): string {
  const named = new URLSearchParams(location.search).get("connect");
  return named ?? `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/`;
}

function reportMissingPanel(): void {
  const panel = new URLSearchParams(location.search).get("panel");
  if (panel && !opening) {
    studio.session.addStatus({ level: 1, text: `There is no panel “${panel}”; the whole page is shown` });
  }
}

const worker = new Worker(new URL("./connection/worker.ts", import.meta.url), { type: "module" });
const file = opening?.details.layout;
const arrangement = file === undefined ? undefined : await fetchArrangement(file);
const studio = new Studio(worker, arrangement, opening?.details.fixed_frame);
installTestHooks(studio);
listenToKeys(attachedWorld);
reportMissingPanel();
render(<App studio={studio} />, document.getElementById("app") as HTMLElement);
studio.start(serverUrl());
if (!needsExtensions) {
  // After the first paint: the page's own panels do not wait for those of packages.
  requestAnimationFrame(() => setTimeout(() => void loadExtensions()));
}
