// Tabs within a panel or dialog, with the keys of the ARIA pattern.
interface TabsProps<T extends string> {
  label: string;
  tabs: readonly (readonly [id: T, title: string])[];
  active: T;
  onChange(id: T): void;
}

export function Tabs<T extends string>({ label, tabs, active, onChange }: TabsProps<T>) {
  const step = (event: KeyboardEvent & { currentTarget: HTMLElement }) => {
    const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (by !== undefined) {
      const place = (tabs.findIndex(([id]) => id === active) + by + tabs.length) % tabs.length;
      onChange((tabs[place] as (typeof tabs)[number])[0]);
      event.currentTarget.querySelectorAll<HTMLElement>("[role=tab]")[place]?.focus();
      event.preventDefault();
    }
  };
  return (
    <div class="tabs" role="tablist" aria-label={label} onKeyDown={step}>
      {tabs.map(([id, title]) => (
        <button
          key={id}
          role="tab"
          class={`tab ${id === active ? "active" : ""}`}
          aria-selected={id === active}
          tabIndex={id === active ? 0 : -1}
          data-tab={id}
          onClick={() => onChange(id)}
        >
          {title}
        </button>
      ))}
    </div>
  );
}
