// Publish: sends messages once or again and again, as rqt's publisher does.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { NumberField } from "../ui/editors";
import { Empty } from "../ui/empty";
import { Icon } from "../ui/icons";
import { DraftField, NameField, useDraft } from "./call/editor";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/call.css";

function PublishPanel({ studio: { session }, params, remember }: PanelProps) {
  const name = useSignal(typeof params.topic === "string" ? params.topic : "");
  const rate = useSignal(1);
  const isRepeating = useSignal(false);
  const topic = session.topics.value.find((each) => each.name === name.value && each.known);
  const draft = useDraft(session, "topic", name.value, topic !== undefined);
  const publish = () => {
    const message = draft.read();
    if (topic && message !== undefined) {
      session.publish(topic.name, topic.type, message);
    } else {
      isRepeating.value = false;
    }
  };
  const repeats = isRepeating.value && topic !== undefined;
  useEffect(() => {
    const timer = repeats ? setInterval(publish, 1000 / rate.value) : undefined;
    return () => clearInterval(timer);
  }, [repeats, rate.value, topic?.name, topic?.type]);
  const published = session.lastPublished.value;
  const error = published?.topic === name.value ? published.error : undefined;
  return (
    <div class="column">
      <div class="bar wrap">
        <NameField
          id="topic-name"
          label="Topic, such as /cmd_vel"
          value={name.value}
          names={session.topics.value.map((each) => each.name)}
          onChange={(chosen) => {
            [name.value, isRepeating.value] = [chosen, false];
            remember({ topic: chosen });
          }}
        />
        <button class="button primary" data-test="publish" disabled={!topic} onClick={publish}>
          <Icon name="arrow" /> Publish
        </button>
        <button
          class={`chip ${repeats ? "on" : ""}`}
          data-test="repeat"
          aria-pressed={repeats}
          disabled={!topic}
          onClick={() => (isRepeating.value = !isRepeating.value)}
        >
          again at
        </button>
        <NumberField
          label="Rate"
          value={rate.value}
          min={0.1}
          max={100}
          step={1}
          unit="Hz"
          onChange={(hertz) => (rate.value = hertz)}
        />
      </div>
      {topic ? (
        <DraftField draft={draft} label="Message" />
      ) : (
        <Empty icon="topics" title={name.value ? "This topic does not exist" : "No topic selected"}>
          {name.value ? "" : "Type a part of its name above."}
        </Empty>
      )}
      <footer class="bar faint">
        <span class="ellipsis">{topic?.type ?? ""}</span>
        <span class="stretch" />
        <span class="error-text ellipsis" role="alert">
          {draft.error.value || error}
        </span>
      </footer>
    </div>
  );
}

export default {
  id: "publish",
  title: "Publish",
  icon: "arrow",
  mount: withPreact(PublishPanel),
} satisfies BuiltInPanel;
