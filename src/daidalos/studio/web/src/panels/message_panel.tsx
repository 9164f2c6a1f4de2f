// Message: the newest message of a topic, as a tree.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { formatTime } from "../ros/time";
import { Choice } from "../ui/editors";
import { Empty } from "../ui/empty";
import { Icon } from "../ui/icons";
import { Fields } from "./message/fields";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/message.css";

const REFRESH_MS = 100;

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
          title={paused.value ? "Resume" : "Pause"}
          onClick={() => (paused.value = !paused.value)}
        >
          <Icon name={paused.value ? "play" : "pause"} />
        </button>
      </div>
      {topic === "" ? (
        <Empty icon="message" title="No topic selected">
          Select one above, or click one in Topics.
        </Empty>
      ) : latest.value ? (
        <>
          <div class="scroll tree" data-test="message">
            <Fields studio={studio} value={latest.value.message} path={topic} depth={0} />
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

export default {
  id: "message",
  title: "Message",
  icon: "message",
  beside: ["topics", 330],
  mount: withPreact(MessagePanel),
} satisfies BuiltInPanel;
