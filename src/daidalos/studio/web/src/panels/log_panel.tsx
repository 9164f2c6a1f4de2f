// Log: messages of nodes on /rosout.
import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { Log } from "../generated/rcl_interfaces";
import { formatTime, toSeconds } from "../ros/time";
import { Choice } from "../ui/editors";
import { Empty } from "../ui/empty";
import { Icon } from "../ui/icons";
import { SearchField } from "../ui/search";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/log.css";

const KEEP = 256;
const KEPT_LINES = 2000;
const SHOWN_LINES = 300;
const REFRESH_MS = 100;
const TOGETHER_MS = 2000;

const LEVELS = [
  [Log.DEBUG, "debug"],
  [Log.INFO, "info"],
  [Log.WARN, "warn"],
  [Log.ERROR, "error"],
  [Log.FATAL, "fatal"],
] as const;

interface Line {
  key: number;
  /** When it came, by the page's clock. */
  at: number;
  log: Log;
}

function LogPanel({ studio, visible }: PanelProps) {
  const lines = useSignal<readonly Line[]>([]);
  const minLevel = useSignal<number>(Log.INFO);
  const filter = useSignal("");
  const list = useRef<HTMLDivElement>(null);
  const follows = useRef(true);
  useEffect(() => {
    let pending: Line[] = [];
    let key = 0;
    // Also while hidden, so that earlier messages are there when the panel is opened.
    const stop = studio.session.subscribe<Log>("/rosout", KEEP, (log) =>
      pending.push({ key: ++key, at: performance.now(), log }),
    );
    const timer = setInterval(() => {
      if (pending.length) {
        lines.value = inOrder([...lines.value, ...pending].slice(-KEPT_LINES));
        pending = [];
      }
    }, REFRESH_MS);
    return () => {
      stop();
      clearInterval(timer);
    };
  }, []);
  const wanted = filter.value.toLowerCase();
  const shown = visible.value
    ? lines.value
        .filter(({ log }) => log.level >= minLevel.value && `${log.name} ${log.msg}`.toLowerCase().includes(wanted))
        .slice(-SHOWN_LINES)
    : [];
  useEffect(() => {
    if (follows.current && list.current) {
      list.current.scrollTop = list.current.scrollHeight;
    }
  });
  return (
    <div class="column">
      <div class="bar">
        <Choice
          label="Minimum severity"
          value={String(minLevel.value)}
          options={LEVELS.map(([level, name]) => [String(level), name])}
          onChange={(level) => (minLevel.value = Number(level))}
        />
        <SearchField value={filter.value} placeholder="Filter" onChange={(text) => (filter.value = text)} />
        <button class="icon-button" title="Clear" onClick={() => (lines.value = [])}>
          <Icon name="trash" />
        </button>
      </div>
      {shown.length === 0 ? (
        <Empty icon="log" title="No log messages">
          {lines.value.length ? "No message matches the filter." : "Log messages of nodes appear here."}
        </Empty>
      ) : (
        <div
          class="scroll log"
          ref={list}
          onScroll={({ currentTarget: box }) => {
            follows.current = box.scrollHeight - box.scrollTop - box.clientHeight < 24;
          }}
        >
          {shown.map(({ key, log }) => (
            <LogLine key={key} log={log} />
          ))}
        </div>
      )}
    </div>
  );
}

/** Sort recent messages by their stamps: every node sends its latched messages at once when the page subscribes. */
function inOrder(lines: Line[]): Line[] {
  const since = performance.now() - TOGETHER_MS;
  const old = lines.filter(({ at }) => at < since);
  const time = ({ log }: Line) => toSeconds(log.stamp);
  return [...old, ...lines.slice(old.length).sort((a, b) => time(a) - time(b))];
}

function LogLine({ log }: { log: Log }) {
  const level = [...LEVELS].reverse().find(([least]) => log.level >= least)?.[1] ?? "debug";
  return (
    <div class={`log-line ${level}`} title={log.file && `${log.file}:${log.line} ${log.function}`}>
      <span class="log-time figures">{formatTime(toSeconds(log.stamp))}</span>
      <span class={`log-level ${level}`}>{level}</span>
      <span class="log-name ellipsis" title={log.name}>
        {log.name}
      </span>
      <span class="log-text">{log.msg}</span>
    </div>
  );
}

export default {
  id: "log",
  title: "Log",
  icon: "log",
  mount: withPreact(LogPanel),
} satisfies BuiltInPanel;
