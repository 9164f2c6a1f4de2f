// A field to filter a list by.
import { Icon } from "./icons";

interface SearchProps {
  value: string;
  placeholder: string;
  onChange(text: string): void;
}

export function SearchField({ value, placeholder, onChange }: SearchProps) {
  return (
    <label class="field search">
      <Icon name="search" size={14} />
      <input
        type="text"
        value={value}
        placeholder={placeholder}
        aria-label={placeholder}
        onInput={(event) => onChange(event.currentTarget.value)}
      />
    </label>
  );
}
