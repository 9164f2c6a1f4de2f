// Player: the time line of a bag that `ros2 bag play` plays, with its speed, pauses and steps.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { Session } from "../contract";
import type { GetParameters } from "../generated/rcl_interfaces";
import type { GetRate, IsPaused, Pause, PlayNext, Resume, Seek, SetRate } from "../generated/rosbag2_interfaces";
import { toStamp } from "../ros/time";
import { Choice } from "../ui/editors";
import { Empty } from "../ui/empty";
import { Icon } from "../ui/icons";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/bag_player.css";

const SERVICE = "/is_paused";
const TYPE = "rosbag2_interfaces/srv/IsPaused";
const PERIOD_MS = 1000;
const RATES = [0.1, 0.25, 0.5, 1, 2, 4, 10];

interface Range {
  start: number;
  end: number;
}

function BagPlayerPanel({ studio, visible }: PanelProps) {
  const { session } = studio;
  const players = session.services.value
    .filter(({ name, type }) => type === TYPE && name.endsWith(SERVICE))
    .map(({ name }) => name.slice(0, -SERVICE.length));
  const [player] = players;
  return player === undefined ? (
    <Empty icon="play" title="No bag is played">
      ros2 bag play BAG --clock
    </Empty>
  ) : (
    <Player key={player} session={session} player={player} now={() => studio.now()} isVisible={visible.value} />
  );
}

interface PlayerProps {
  session: Session;
  player: string;
  now(): number;
  isVisible: boolean;
}

function Player({ session, player, now, isVisible }: PlayerProps) {
  const range = useSignal<Range | undefined>(undefined);
  const time = useSignal(0);
  const isPaused = useSignal(false);
  const rate = useSignal(1);
  const error = useSignal("");
  /** Where the user drags to; undefined: nowhere. */
  const target = useSignal<number | undefined>(undefined);
  const attempt = async (work: () => Promise<unknown>) => {
    try {
      await work();
      error.value = "";
    } catch (problem) {
      error.value = problem instanceof Error ? problem.message : String(problem);
    }
  };
  const read = async () => {
    range.value ??= await readRange(session, player);
    isPaused.value = (await session.call<IsPaused>(`${player}${SERVICE}`, {})).paused;
    rate.value = (await session.call<GetRate>(`${player}/get_rate`, {})).rate;
  };
  useEffect(() => {
    if (!isVisible) {
      return undefined;
    }
    void attempt(read);
    const polling = setInterval(() => void attempt(read), PERIOD_MS);
    const showing = setInterval(() => (time.value = now()), PERIOD_MS / 10);
    return () => [polling, showing].forEach(clearInterval);
  }, [isVisible]);
  const toggle = () =>
    attempt(async () => {
      await (isPaused.value
        ? session.call<Resume>(`${player}/resume`, {})
        : session.call<Pause>(`${player}/pause`, {}));
      await read();
    });
  const seek = (to: number) =>
    attempt(async () => {
      const { success } = await session.call<Seek>(`${player}/seek`, { time: toStamp(to) });
      target.value = undefined;
      if (!success) {
        throw new Error("the player did not go there");
      }
    });
  const { start, end } = range.value ?? { start: 0, end: 0 };
  const shown = Math.min(end, Math.max(start, target.value ?? time.value));
  return (
    <div class="column bag-player">
      <div class="bar">
        <button
          class="icon-button"
          title={isPaused.value ? "Play" : "Pause"}
          data-test="pause"
          aria-pressed={isPaused.value}
          onClick={() => void toggle()}
        >
          <Icon name={isPaused.value ? "play" : "pause"} />
        </button>
        <button
          class="icon-button"
          title="Next message, while it is paused"
          disabled={!isPaused.value}
          data-test="next"
          onClick={() => void attempt(() => session.call<PlayNext>(`${player}/play_next`, {}))}
        >
          <Icon name="step" />
        </button>
        <span class="figures grow" data-test="bag-time">
          {(shown - start).toFixed(1)} <span class="faint">of {(end - start).toFixed(1)} s</span>
        </span>
        <Choice
          label="Rate"
          value={String(rate.value)}
          options={[...new Set([...RATES, rate.value])].sort((a, b) => a - b).map((each) => [String(each), `${each}×`])}
          onChange={(chosen) =>
            void attempt(async () => {
              await session.call<SetRate>(`${player}/set_rate`, { rate: Number(chosen) });
              await read();
            })
          }
        />
      </div>
      <input
        class="slider"
        type="range"
        aria-label="Time in the bag"
        disabled={end <= start}
        min={start}
        max={end}
        step="any"
        value={shown}
        style={`--from: 0%; --to: ${end > start ? (100 * (shown - start)) / (end - start) : 0}%`}
        onInput={(event) => (target.value = Number(event.currentTarget.value))}
        onChange={(event) => void seek(Number(event.currentTarget.value))}
      />
      <span class="error-text ellipsis" role="alert" title={error.value}>
        {error.value}
      </span>
    </div>
  );
}

/** The first and last time of the player's bag [s]; undefined where the player does not tell. */
async function readRange(session: Session, player: string): Promise<Range | undefined> {
  const names = ["bag_start_ns", "bag_end_ns"];
  const { values } = await session.call<GetParameters>(`${player}/get_parameters`, { names });
  const [start, end] = values.map(({ integer_value }) => Number(integer_value) * 1e-9);
  return start !== undefined && end !== undefined && end > start ? { start, end } : undefined;
}

export default {
  id: "bag_player",
  title: "Bag player",
  icon: "play",
  mount: withPreact(BagPlayerPanel),
} satisfies BuiltInPanel;
