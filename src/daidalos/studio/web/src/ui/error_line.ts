// One line in place of a panel that cannot be shown.

export function showErrorLine(element: HTMLElement, text: string): void {
  const line = document.createElement("div");
  line.className = "empty";
  line.setAttribute("role", "alert");
  line.textContent = text;
  element.replaceChildren(line);
}
