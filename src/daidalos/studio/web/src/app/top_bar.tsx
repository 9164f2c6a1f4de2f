// The bar at the top: name, state of the connection, robot time, and menus.
import { PANELS } from "../panels/registry";
import { formatTime } from "../ros/time";
import { Icon, iconNamed } from "../ui/icons";
import { Menu, MenuItem, MenuSeparator } from "../ui/menu";
import { helpIsOpen } from "./help_state";
import type { Layout } from "./layout";
import type { Studio } from "./studio";
import { theme, toggleTheme } from "./theme";

const LINK_WORDS = { connecting: "Connecting", connected: "Connected", lost: "Reconnecting" } as const;

export function TopBar({ studio, layout }: { studio: Studio; layout: () => Layout }) {
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
      <Menu label="Panels" icon="panel">
        {PANELS.list.map((panel) => (
          <MenuItem key={panel.id} icon={iconNamed(panel.icon, "panel")} onChoose={() => layout().open(panel)}>
            {panel.title}
          </MenuItem>
        ))}
        <MenuSeparator />
        <MenuItem icon="layout" onChoose={() => layout().reset()}>
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
  const { time, factor } = studio.reading.value;
  if (time === undefined || studio.session.link.value !== "connected") {
    return null;
  }
  const still = factor !== undefined && factor === 0;
  return (
    <span class="clock">
      <span class="clock-field" title={factor === undefined ? "Robot time" : "Simulated time"}>
        <span class="faint">{factor === undefined ? "Time" : "Sim"}</span>
        <span class="figures">{formatTime(time)}</span>
      </span>
      {factor !== undefined && (
        <span class="clock-field" title="Simulated seconds per second">
          <span class="faint">RTF</span>
          <span class="figures">{still ? "paused" : `${factor.toFixed(2)}×`}</span>
        </span>
      )}
    </span>
  );
}
