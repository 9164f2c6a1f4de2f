// Message: the newest message of a topic, as a tree.
import { useSignal } from "@preact/signals";
import { useEffect, useState } from "preact/hooks";
import { formatTime } from "../ros/time";
import { isTypedArray } from "../ros/fields";
import { Choice } from "../ui/editors";
import { Empty } from "../ui/empty";
import { Icon } from "../ui/icons";
import { PLOT_DRAG } from "./plot/drag";
import type { PanelProps, PanelType } from "./panel";

const REFRESH_MS = 100;
const ARRAY_PREVIEW = 4;
const ARRAY_PAGE = 50;
const OPEN_DEPTH = 2;
const LONGEST_TEXT = 400;

interface Latest {
  message: unknown;
  time: number;
  count: number;
}

function MessagePanel({ studio, visible }: PanelProps) {
  const { session, selectedTopic } = studio;
  const topic = selectedTopic.value;
  const latest = useSignal<Latest | undefined>(undefined);
  const paused = useSignal(false);
  const listens = visible.value && topic !== "" && !paused.value;
  useEffect(() => {
    if (!listens) {
      return undefined;
    }
    let pending: Latest | undefined;
    let count = 0;
    const stop = session.subscribe(topic, 1, (message, time) => (pending = { message, time, count: ++count }));
    const timer = setInterval(() => {
      if (pending) {
        latest.value = pending;
        pending = undefined;
      }
    }, REFRESH_MS);
    return () => {
      stop();
      clearInterval(timer);
    };
  }, [topic, listens]);
  useEffect(() => {
    latest.value = undefined;
  }, [topic]);
  const type = session.typeOf(topic);
  return (
    <div class="column">
      <div class="bar">
        <Choice
          label="Topic"
          value={topic}
          options={session.topics.value.map(({ name }) => [name, name])}
          onChange={(name) => (selectedTopic.value = name)}
        />
        <button
          class={`icon-button ${paused.value ? "active" : ""}`}
          title={paused.value ? "Go on" : "Hold"}
          onClick={() => (paused.value = !paused.value)}
        >
          <Icon name={paused.value ? "play" : "pause"} />
        </button>
      </div>
      {topic === "" ? (
        <Empty icon="message" title="No topic chosen">
          Choose one above, or click one in Topics.
        </Empty>
      ) : latest.value ? (
        <>
          <div class="scroll tree" data-test="message">
            <Fields value={latest.value.message} path={topic} depth={0} />
          </div>
          <footer class="bar faint">
            <span class="ellipsis">{type}</span>
            <span class="stretch" />
            <span class="figures">{formatTime(latest.value.time)}</span>
          </footer>
        </>
      ) : (
        <Empty icon="message" title={`Nothing on ${topic} yet`}>
          {type ?? "The topic does not exist"}
        </Empty>
      )}
    </div>
  );
}

function Fields({ value, path, depth }: { value: unknown; path: string; depth: number }) {
  return (
    <>
      {entries(value).map(([name, field]) => (
        <Field key={name} name={name} value={field} path={`${path}/${name}`} depth={depth} />
      ))}
    </>
  );
}

interface FieldProps {
  name: string;
  value: unknown;
  path: string;
  depth: number;
}

function Field({ name, value, path, depth }: FieldProps) {
  const nested = typeof value === "object" && value !== null;
  const [open, setOpen] = useState(nested && depth < OPEN_DEPTH && !isArray(value));
  const [shown, setShown] = useState(ARRAY_PAGE);
  const indent = { paddingLeft: `${8 + depth * 14}px` };
  if (!nested) {
    return (
      <div
        class="tree-row leaf"
        style={indent}
        draggable={typeof value === "number" || typeof value === "bigint" || typeof value === "boolean"}
        onDragStart={(event) => event.dataTransfer?.setData(PLOT_DRAG, path)}
        title={path}
      >
        <span class="turn" />
        <span class="key">{name}</span>
        <span class={`value ${typeof value}`}>{leaf(value)}</span>
      </div>
    );
  }
  const length = isArray(value) ? value.length : 0;
  return (
    <>
      <button class="bare tree-row" style={indent} aria-expanded={open} onClick={() => setOpen(!open)}>
        <span class="turn">
          <Icon name="chevron" size={11} />
        </span>
        <span class="key">{name}</span>
        <span class="summary ellipsis">{open ? "" : summary(value)}</span>
      </button>
      {open && <Fields value={isArray(value) ? head(value, shown) : value} path={path} depth={depth + 1} />}
      {open && length > shown && (
        <button class="bare tree-row more" style={indent} onClick={() => setShown(shown + ARRAY_PAGE)}>
          {length - shown} more
        </button>
      )}
    </>
  );
}

type AnyArray = ArrayLike<unknown>;

function isArray(value: unknown): value is AnyArray {
  return Array.isArray(value) || isTypedArray(value);
}

function entries(value: unknown): [string, unknown][] {
  if (isArray(value)) {
    return Array.from(value, (each, i) => [String(i), each]);
  }
  return typeof value === "object" && value !== null ? Object.entries(value) : [];
}

function head(value: AnyArray, count: number): unknown[] {
  return Array.from({ length: Math.min(count, value.length) }, (_, i) => value[i]);
}

function leaf(value: unknown): string {
  switch (typeof value) {
    case "number":
      return Number.isInteger(value) ? String(value) : String(Number(value.toPrecision(7)));
    case "string":
      return value.length > LONGEST_TEXT ? `${value.slice(0, LONGEST_TEXT)}…` : value || "(empty)";
  }
  return String(value);
}

function summary(value: unknown): string {
  if (isArray(value)) {
    const numbers = value.length > 0 && typeof value[0] !== "object";
    const preview = numbers
      ? `: ${head(value, ARRAY_PREVIEW).map(leaf).join(", ")}${value.length > ARRAY_PREVIEW ? ", …" : ""}`
      : "";
    return `${value.length} items${preview}`;
  }
  const fields = entries(value);
  const plain = fields.every(([, field]) => typeof field !== "object");
  return plain ? fields.map(([name, field]) => `${name} ${leaf(field)}`).join("  ") : `${fields.length} fields`;
}

export const MESSAGE_PANEL: PanelType = { id: "message", title: "Message", icon: "message", component: MessagePanel };
