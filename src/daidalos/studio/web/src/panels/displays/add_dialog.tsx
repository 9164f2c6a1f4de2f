// "Add display": by the kind of display, or by a topic and what can show it, as RViz has it.
import { useSignal } from "@preact/signals";
import type { Studio } from "../../app/studio";
import type { DisplayType, TopicInfo } from "../../contract";
import { DISPLAYS } from "../../displays/registry";
import type { Registered } from "../../registry";
import { Dialog } from "../../ui/dialog";
import { Icon, iconNamed } from "../../ui/icons";
import { SearchField } from "../../ui/search";
import { Tabs } from "../../ui/tabs";

const TABS = [
  ["type", "By display type"],
  ["topic", "By topic"],
] as const;

export function AddDialog({ studio, onClose }: { studio: Studio; onClose(): void }) {
  const tab = useSignal<"type" | "topic">("type");
  const filter = useSignal("");
  const wanted = filter.value.trim().toLowerCase();
  const add = (display: Registered<DisplayType>, topic?: string) => {
    studio.displays.add(display, topic);
    onClose();
  };
  return (
    <Dialog title="Add display" class="add-display" onClose={onClose}>
      <Tabs label="How to choose" tabs={TABS} active={tab.value} onChange={(id) => (tab.value = id)} />
      <SearchField
        value={filter.value}
        placeholder={tab.value === "type" ? "Filter displays" : "Filter topics"}
        onChange={(text) => (filter.value = text)}
      />
      <div class="scroll add-list" role="tabpanel" aria-label={tab.value === "type" ? TABS[0][1] : TABS[1][1]}>
        {tab.value === "type" ? (
          <ByType wanted={wanted} onAdd={add} />
        ) : (
          <ByTopic topics={studio.session.topics.value} wanted={wanted} onAdd={add} />
        )}
      </div>
    </Dialog>
  );
}

interface ListProps {
  wanted: string;
  onAdd(display: Registered<DisplayType>, topic?: string): void;
}

function ByType({ wanted, onAdd }: ListProps) {
  return DISPLAYS.list
    .filter(({ id, messages }) => [id, ...messages].some((each) => each.toLowerCase().includes(wanted)))
    .map((display) => (
      <button key={display.id} class="menu-item" data-add={display.id} onClick={() => onAdd(display)}>
        <Icon name={iconNamed(display.icon, "cube")} />
        <span class="ellipsis">{display.id}</span>
        <span class="faint note">{display.messages.map((type) => type.replace("/msg/", "/")).join(", ")}</span>
      </button>
    ));
}

function ByTopic({ topics, wanted, onAdd }: ListProps & { topics: readonly TopicInfo[] }) {
  const found = topics
    .map((topic) => ({ topic, displays: DISPLAYS.list.filter(({ messages }) => messages.includes(topic.type)) }))
    .filter(
      ({ topic: { name, type }, displays }) => displays.length && `${name} ${type}`.toLowerCase().includes(wanted),
    );
  if (!found.length) {
    return <p class="faint add-none">{wanted ? "No topic matches." : "No topic has a display yet."}</p>;
  }
  return found.map(({ topic: { name, type }, displays }) => (
    <section key={name} class="add-topic">
      <h3>
        <span class="ellipsis">{name}</span>
        <span class="faint note">{type.replace("/msg/", "/")}</span>
      </h3>
      {displays.map((display) => (
        <button
          key={display.id}
          class="menu-item"
          data-add={`${name} ${display.id}`}
          onClick={() => onAdd(display, name)}
        >
          <Icon name={iconNamed(display.icon, "cube")} />
          {display.id}
        </button>
      ))}
    </section>
  ));
}
