// The bar at the top: name, state of the connection, robot time, and menus.
import type { ReadonlySignal } from "@preact/signals";
import { useRef } from "preact/hooks";
import { PANELS } from "../panels/registry";
import { formatTime } from "../ros/time";
import { followed } from "../scene/world";
import { Icon, iconNamed } from "../ui/icons";
import { Menu, MenuItem, MenuSeparator } from "../ui/menu";
import { ACCEPTED, openFile, saveLayout, savePlots, saveRviz } from "./files";
import { helpIsOpen } from "./help_state";
import type { Layout } from "./layout";
import type { Studio } from "./studio";
import { attachedWorld } from "./test_hooks";
import { theme, toggleTheme } from "./theme";

const LINK_WORDS = {
  connecting: "Connecting",
  connected: "Connected",
  silent: "Silent",
  lost: "Reconnecting",
} as const;

interface Props {
  studio: Studio;
  layout: ReadonlySignal<Layout | undefined>;
}

export function TopBar({ studio, layout }: Props) {
  const closed = layout.value?.lastClosed;
  return (
    <header class="top-bar">
      <span class="brand">
        <Mark />
        <span class="wide-only">Daidalos</span>
      </span>
      <Connection studio={studio} />
      <LatestStatus studio={studio} />
      <span class="stretch" />
      <Clock studio={studio} />
      <span class="stretch" />
      <FileMenu studio={studio} layout={layout} />
      <Menu label="Panels" icon="panel">
        {PANELS.list.map((panel) => (
          <MenuItem key={panel.id} icon={iconNamed(panel.icon, "panel")} onChoose={() => layout.value?.open(panel)}>
            {panel.title}
          </MenuItem>
        ))}
        <MenuSeparator />
        {closed && (
          <MenuItem icon="undo" onChoose={() => layout.value?.reopen()}>
            Reopen “{closed.title}”
          </MenuItem>
        )}
        <MenuItem icon="layout" onChoose={() => layout.value?.reset()}>
          Reset layout
        </MenuItem>
        <MenuItem icon="reset" onChoose={() => studio.displays.reset()}>
          Reset displays
        </MenuItem>
      </Menu>
      <button class="icon-button" title="Keyboard and mouse (?)" onClick={() => (helpIsOpen.value = true)}>
        <Icon name="help" />
      </button>
      <button class="icon-button" title="Dark or light theme (d)" onClick={toggleTheme} data-test="theme">
        <Icon name={theme.value === "dark" ? "sun" : "moon"} />
      </button>
    </header>
  );
}

function FileMenu({ studio, layout }: Props) {
  const file = useRef<HTMLInputElement>(null);
  const attempt = (work: Promise<void>) =>
    void work.catch((error: Error) => studio.session.addStatus({ level: 2, text: error.message }));
  const save = () => attempt(saveRviz(studio, attachedWorld()?.viewport.view.state(), followed.value));
  return (
    <span>
      <Menu label="File" icon="file" test="file">
        <MenuItem icon="open" note=".rviz, PlotJuggler, layout" onChoose={() => file.current?.click()}>
          Open…
        </MenuItem>
        <MenuSeparator />
        <MenuItem icon="save" note="displays and view" onChoose={save}>
          Save as .rviz
        </MenuItem>
        <MenuItem icon="save" note="plots" onChoose={() => layout.value && attempt(savePlots(studio, layout.value))}>
          Save as PlotJuggler .xml
        </MenuItem>
        <MenuItem
          icon="save"
          note="panels and displays"
          onChoose={() => layout.value && saveLayout(layout.value.state)}
        >
          Save layout
        </MenuItem>
      </Menu>
      <input
        ref={file}
        type="file"
        accept={ACCEPTED}
        hidden
        data-test="layout-file"
        onChange={({ currentTarget }) => {
          const [chosen] = currentTarget.files ?? [];
          if (chosen) {
            attempt(openFile(chosen));
          }
          currentTarget.value = "";
        }}
      />
    </span>
  );
}

function Mark() {
  return (
    <svg class="mark" width="18" height="18" viewBox="0 0 32 32" aria-hidden="true">
      <path d="M4 28V4h24v24H10V10h12v12h-6v-6" />
    </svg>
  );
}

function Connection({ studio: { session } }: { studio: Studio }) {
  const state = session.link.value;
  return (
    <span class={`pill ${state}`} data-test="connection" role="status">
      <span class="dot" />
      <span class={state === "connected" ? "wide-only" : ""}>{LINK_WORDS[state]}</span>
      {state === "connected" && session.serverName.value && (
        <span class="faint ellipsis roomy-only">{session.serverName.value}</span>
      )}
    </span>
  );
}

/** The latest status message of the server, until it is dismissed. */
function LatestStatus({ studio: { session } }: { studio: Studio }) {
  const last = session.statuses.value.at(-1);
  if (!last) {
    return null;
  }
  return (
    <span class={`pill status level-${last.level}`} title={last.text}>
      <span class="ellipsis">{last.text}</span>
      <button class="bare" title="Dismiss" onClick={() => (session.statuses.value = [])}>
        <Icon name="close" size={12} />
      </button>
    </span>
  );
}

function Clock({ studio }: { studio: Studio }) {
  const { time, factor, isSimulated } = studio.reading.value;
  if (time === undefined || studio.session.link.value !== "connected") {
    return null;
  }
  return (
    <span class="clock">
      <span class="clock-field" title={isSimulated ? "Simulated time" : "Robot time"}>
        <span class="faint">{isSimulated ? "Sim" : "Time"}</span>
        <span class="figures">{formatTime(time)}</span>
      </span>
      {isSimulated && (
        <span class="clock-field" title="Real-time factor: simulated seconds per second">
          <span class="faint">RTF</span>
          <span class="figures" data-test="rtf">
            {factor === undefined ? "…" : factor === 0 ? "paused" : `${factor.toFixed(2)}×`}
          </span>
        </span>
      )}
    </span>
  );
}
