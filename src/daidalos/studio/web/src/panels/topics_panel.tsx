// Topics: names, types, rates and bandwidths.
import { useSignal } from "@preact/signals";
import { useEffect, useState } from "preact/hooks";
import type { Studio } from "../app/studio";
import type { Traffic } from "../connection/boundary";
import type { TopicInfo } from "../contract";
import { displayFor } from "../displays/registry";
import { Empty } from "../ui/empty";
import { Icon } from "../ui/icons";
import { SearchField } from "../ui/search";
import { Fields } from "./message/fields";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/topics.css";

/** Large messages: subscribing only to measure their rate would make the robot send them. */
const HEAVY = new Set([
  "sensor_msgs/msg/Image",
  "sensor_msgs/msg/CompressedImage",
  "sensor_msgs/msg/PointCloud2",
  "sensor_msgs/msg/PointCloud",
]);

/** Topics that every node has: listed at the end, folded. */
const INNER = /\/(transition_event|parameter_events|rosout|bond)$/;
const REFRESH_MS = 150;
/** The depth to which fields are unfolded. */
const UNFOLDED = 5;

function TopicsPanel({ studio, visible }: PanelProps) {
  const filter = useSignal("");
  const showsStandard = useSignal(false);
  const { session } = studio;
  const wanted = filter.value.toLowerCase();
  const topics = session.topics.value.filter(
    ({ name, type }) =>
      (name.toLowerCase().includes(wanted) || type.toLowerCase().includes(wanted)) &&
      (wanted.includes("_") || !isHidden(name)),
  );
  const inner = topics.filter(({ name }) => INNER.test(name));
  const outer = topics.filter(({ name }) => !INNER.test(name));
  const shown = showsStandard.value || wanted !== "" ? topics : outer;
  const measured = visible.value ? shown.filter(({ type }) => !HEAVY.has(type)).map(({ name }) => name) : [];
  useEffect(() => {
    const stops = measured.map((name) => session.subscribe(name, 0, () => undefined));
    return () => {
      for (const stop of stops) {
        stop();
      }
    };
  }, [measured.join()]);
  const rows = (some: readonly TopicInfo[]) =>
    some.map((topic) => (
      <TopicRow key={`${topic.name} ${topic.type}`} studio={studio} topic={topic} isVisible={visible.value} />
    ));
  if (session.topics.value.length === 0) {
    return (
      <Empty icon="topics" title="No topics yet">
        They appear as soon as a node publishes.
      </Empty>
    );
  }
  return (
    <div class="column">
      <div class="bar">
        <SearchField
          value={filter.value}
          placeholder="Filter by name or type"
          onChange={(text) => (filter.value = text)}
        />
        <span class="faint figures">{topics.length}</span>
      </div>
      <div class="scroll">
        {rows(outer)}
        {inner.length > 0 && !wanted && (
          <button
            class="bare topics-standard"
            aria-expanded={showsStandard.value}
            onClick={() => (showsStandard.value = !showsStandard.value)}
          >
            <span class="turn">
              <Icon name="chevron" size={11} />
            </span>
            {inner.length} standard topics
          </button>
        )}
        {(showsStandard.value || wanted !== "") && rows(inner)}
      </div>
    </div>
  );
}

function TopicRow({ studio, topic, isVisible }: { studio: Studio; topic: TopicInfo; isVisible: boolean }) {
  const traffic = studio.session.traffic.value[topic.name];
  const selected = studio.selectedTopic.value === topic.name;
  const display = displayFor(topic.type);
  const isShown = studio.displays.configs.some(({ settings }) => settings.topic === topic.name);
  const [isOpen, setOpen] = useState(false);
  const select = () => {
    studio.selectedTopic.value = topic.name;
    studio.openPanel("message");
  };
  return (
    <>
      <div class={`topic-row ${selected ? "selected" : ""}`} data-topic={topic.name}>
        <button
          class="turn"
          aria-expanded={isOpen}
          title={isOpen ? "Hide its fields" : "Show its fields"}
          disabled={!topic.known}
          data-test="fields"
          onClick={() => setOpen(!isOpen)}
        >
          <Icon name="chevron" size={11} />
        </button>
        <button
          class="bare grow"
          onClick={select}
          title={topic.known ? "Show its messages" : "Its definition is not known"}
        >
          <span class="topic-name ellipsis">{topic.name}</span>
          <span class="topic-type ellipsis">{shortType(topic.type)}</span>
        </button>
        <span class="topic-traffic figures">
          <span>{rate(traffic)}</span>
          <span class="faint">{bandwidth(traffic)}</span>
        </span>
        {display && !isShown ? (
          <button
            class="icon-button small"
            title={`Show in 3D as ${display.id}`}
            onClick={() => studio.displays.add(display, topic.name)}
          >
            <Icon name="add" size={14} />
          </button>
        ) : (
          <span class="icon-button small" />
        )}
      </div>
      {isOpen && <TopicFields studio={studio} topic={topic.name} isVisible={isVisible} />}
    </>
  );
}

/** The fields of the newest message; before the first one, those of an empty message. */
function TopicFields({ studio, topic, isVisible }: { studio: Studio; topic: string; isVisible: boolean }) {
  const shown = useSignal<unknown>(undefined);
  const { session } = studio;
  useEffect(() => {
    if (!isVisible) {
      return undefined;
    }
    let newest: unknown;
    const stop = session.subscribe(topic, 1, (message) => (newest = message));
    void session.template("topic", topic).then(
      (empty) => (shown.value ??= empty),
      () => undefined,
    );
    const timer = setInterval(() => {
      if (newest !== undefined && newest !== shown.peek()) {
        shown.value = newest;
      }
    }, REFRESH_MS);
    return () => {
      stop();
      clearInterval(timer);
    };
  }, [topic, isVisible]);
  return (
    <div class="tree topic-fields">
      {shown.value === undefined ? (
        <div class="tree-row faint">…</div>
      ) : (
        <Fields studio={studio} value={shown.value} path={topic} depth={1} unfolded={UNFOLDED} />
      )}
    </div>
  );
}

/** Hidden as in `ros2 topic list`: a part of the name begins with an underscore. */
function isHidden(topic: string): boolean {
  return topic.includes("/_");
}

function shortType(type: string): string {
  return type.replace("/msg/", "/");
}

function rate(traffic: Traffic | undefined): string {
  if (!traffic) {
    return "";
  }
  const { rate: hertz, total } = traffic;
  if (hertz === undefined) {
    return "…";
  }
  return hertz === 0 ? (total ? "still" : "silent") : `${hertz < 9.95 ? hertz.toFixed(1) : hertz.toFixed(0)} Hz`;
}

function bandwidth(traffic: Traffic | undefined): string {
  if (!traffic?.bandwidth) {
    return "";
  }
  const units = ["B/s", "kB/s", "MB/s"];
  let [value, unit] = [traffic.bandwidth, 0];
  while (value >= 1000 && unit < units.length - 1) {
    value /= 1000;
    unit++;
  }
  return `${value < 9.95 ? value.toFixed(1) : value.toFixed(0)} ${units[unit]}`;
}

export default {
  id: "topics",
  title: "Topics",
  icon: "topics",
  mount: withPreact(TopicsPanel),
} satisfies BuiltInPanel;
