// Displays: what the 3-D view draws, as RViz's tree of displays and their properties.
import { useState } from "preact/hooks";
import type { Studio } from "../app/studio";
import type { Property, Status, Value } from "../contract";
import { DISPLAYS } from "../displays/registry";
import type { DisplayConfig } from "../displays/settings";
import { AUTOMATIC } from "../tf/fixed_frame";
import { Choice, ColorField, NumberField, Toggle } from "../ui/editors";
import { Icon, iconNamed } from "../ui/icons";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/displays.css";

import { AddDialog } from "./displays/add_dialog";

function DisplaysPanel({ studio }: PanelProps) {
  const [open, setOpen] = useState<ReadonlySet<string>>(new Set());
  const [adding, setAdding] = useState(false);
  const toggle = (id: string) => {
    const next = new Set(open);
    if (!next.delete(id)) {
      next.add(id);
    }
    setOpen(next);
  };
  return (
    <div class="column">
      <GlobalOptions studio={studio} />
      <div class="scroll displays">
        {studio.displays.configs.map((config) => (
          <DisplayRow
            key={config.id}
            studio={studio}
            config={config}
            open={open.has(config.id)}
            onToggle={() => toggle(config.id)}
          />
        ))}
      </div>
      <footer class="bar">
        <button class="button wide" data-test="add-display" onClick={() => setAdding(true)}>
          <Icon name="add" />
          Add display
        </button>
      </footer>
      {adding && <AddDialog studio={studio} onClose={() => setAdding(false)} />}
    </div>
  );
}

function GlobalOptions({ studio }: { studio: Studio }) {
  const { fixedFrame } = studio;
  const automatic = fixedFrame.chosen.value === AUTOMATIC;
  const options = [
    [AUTOMATIC, automatic ? `automatic (${fixedFrame.current.value})` : "automatic"] as const,
    ...fixedFrame.frames.value.map((frame) => [frame, frame] as const),
  ];
  const remark = fixedFrame.remark.value;
  return (
    <div class="global-options">
      <div class="property">
        <span class="name">Fixed frame</span>
        <Choice
          label="Fixed frame"
          value={fixedFrame.chosen.value}
          options={options}
          onChange={(frame) => (fixedFrame.chosen.value = frame)}
        />
      </div>
      {remark && <div class="remark">{remark}</div>}
    </div>
  );
}

interface RowProps {
  studio: Studio;
  config: DisplayConfig;
  open: boolean;
  onToggle(): void;
}

function DisplayRow({ studio, config, open, onToggle }: RowProps) {
  const { displays } = studio;
  const status = statusOf(studio, config);
  const type = DISPLAYS.find(config.type);
  return (
    <section
      class={`display ${config.enabled ? status.level : "off"} ${open ? "open" : ""}`}
      data-display={config.name}
    >
      <div class="display-head">
        <button class="bare grow" aria-expanded={open} onClick={onToggle} title={status.text}>
          <span class="turn">
            <Icon name="chevron" size={12} />
          </span>
          <span
            class={`type-icon ${config.enabled ? status.level : "off"}`}
            style={
              config.enabled && status.level === "ok"
                ? { color: type?.legend?.(config.settings) ?? "var(--text-soft)" }
                : {}
            }
          >
            <Icon name={iconNamed(type?.icon, "cube")} size={15} />
          </span>
          <span class="ellipsis">{config.name}</span>
          {config.enabled && (status.level === "error" || status.level === "warning") && (
            <span class={`badge ${status.level}`} />
          )}
        </button>
        <Toggle label={`Show ${config.name}`} on={config.enabled} onChange={(on) => displays.enable(config.id, on)} />
      </div>
      {open && (
        <div class="properties">
          <StatusLine status={status} />
          {type?.properties
            .filter((property) => property.when?.(config.settings) ?? true)
            .map((property) => (
              <PropertyRow key={property.key} studio={studio} config={config} property={property} />
            ))}
          <div class="property actions">
            <button class="button small" onClick={() => displays.remove(config.id)}>
              <Icon name="trash" size={13} />
              Remove
            </button>
          </div>
        </div>
      )}
    </section>
  );
}

function statusOf(studio: Studio, config: DisplayConfig): Status {
  if (!config.enabled) {
    return { level: "idle", text: "disabled" };
  }
  if (studio.session.link.value !== "connected" && config.settings.topic !== undefined) {
    return { level: "idle", text: studio.session.link.value === "silent" ? "the server is silent" : "not connected" };
  }
  if (DISPLAYS.find(config.type) === undefined) {
    return DISPLAYS.isComplete.value
      ? { level: "warning", text: `${config.type}: not supported here; it is kept when the configuration is saved` }
      : { level: "idle", text: "loading" };
  }
  const live = studio.displays.live.value.get(config.id);
  const status = live?.status.value ?? { level: "idle", text: "the 3D panel is closed" };
  const topic = config.settings.topic;
  const missing = typeof topic === "string" && topic !== "" && studio.session.typeOf(topic) === undefined;
  return status.level === "idle" && missing ? { level: "idle", text: `waiting for ${topic}` } : status;
}

function StatusLine({ status }: { status: Status }) {
  return status.text ? (
    <div class={`status-line ${status.level}`}>
      <span class="dot" />
      <span>{status.text}</span>
    </div>
  ) : null;
}

interface PropertyProps {
  studio: Studio;
  config: DisplayConfig;
  property: Property;
}

function PropertyRow({ studio, config, property }: PropertyProps) {
  const value = config.settings[property.key] ?? "";
  const change = (changed: Value) => studio.displays.set(config.id, property.key, changed);
  return (
    <div class="property">
      <span class="name">{property.label}</span>
      <Editor {...{ studio, config, property, value, change }} />
    </div>
  );
}

function Editor({
  studio,
  config,
  property,
  value,
  change,
}: PropertyProps & { value: Value; change(value: Value): void }) {
  switch (property.kind) {
    case "toggle":
      return <Toggle label={property.label} on={Boolean(value)} onChange={change} />;
    case "color":
      return <ColorField label={property.label} value={String(value)} onChange={change} />;
    case "number":
      return <NumberField {...property} unit={property.unit} value={Number(value)} onChange={change} />;
    case "choice":
      return <Choice label={property.label} value={String(value)} options={property.options} onChange={change} />;
    case "topic":
      return <TopicChoice studio={studio} config={config} value={String(value)} onChange={change} />;
  }
}

interface TopicChoiceProps {
  studio: Studio;
  config: DisplayConfig;
  value: string;
  onChange(topic: string): void;
}

function TopicChoice({ studio, config, value, onChange }: TopicChoiceProps) {
  const messages = DISPLAYS.find(config.type)?.messages ?? [];
  const topics = studio.session.topics.value.filter(({ type }) => messages.includes(type));
  return <Choice label="Topic" value={value} options={topics.map(({ name }) => [name, name])} onChange={onChange} />;
}

export default {
  id: "displays",
  title: "Displays",
  icon: "sliders",
  mount: withPreact(DisplaysPanel),
} satisfies BuiltInPanel;
