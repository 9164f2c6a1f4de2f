// A name to choose from many, and a message to edit as text.
import { useSignal, type Signal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { Session } from "../../connection/session";
import { fromText, toText } from "../../ros/text";

interface NameProps {
  id: string;
  label: string;
  value: string;
  names: readonly string[];
  onChange(name: string): void;
}

export function NameField({ id, label, value, names, onChange }: NameProps) {
  return (
    <label class="field grow">
      <input
        type="text"
        list={id}
        value={value}
        placeholder={label}
        aria-label={label}
        spellcheck={false}
        data-test={id}
        onChange={(event) => onChange(event.currentTarget.value.trim())}
      />
      <datalist id={id}>
        {names.map((name) => (
          <option key={name} value={name} />
        ))}
      </datalist>
    </label>
  );
}

export interface Draft {
  text: Signal<string>;
  /** What is wrong with it. */
  error: Signal<string>;
  /** Return the message, or undefined where the text is not valid: then `error` says why. */
  read(): unknown;
}

/** A draft of a request or message, reset when another service or topic is selected. */
export function useDraft(session: Session, of: "service" | "topic", name: string, isThere: boolean): Draft {
  const text = useSignal("");
  const errorText = useSignal("");
  useEffect(() => {
    let isWanted = true;
    [text.value, errorText.value] = ["", ""];
    if (name && isThere) {
      session.template(of, name).then(
        (message) => isWanted && (text.value = toText(message)),
        (error: Error) => isWanted && (errorText.value = error.message),
      );
    }
    return () => {
      isWanted = false;
    };
  }, [name, isThere]);
  const read = () => {
    try {
      errorText.value = "";
      return fromText(text.value || "{}");
    } catch (error) {
      errorText.value = error instanceof Error ? error.message : String(error);
      return undefined;
    }
  };
  return { text, error: errorText, read };
}

export function DraftField({ draft, label }: { draft: Draft; label: string }) {
  return (
    <textarea
      class="draft mono"
      aria-label={label}
      spellcheck={false}
      data-test="draft"
      value={draft.text.value}
      onInput={(event) => (draft.text.value = event.currentTarget.value)}
    />
  );
}
