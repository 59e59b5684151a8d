// A moment in words a person uses: "today at 14:05", "yesterday at 9:30", "on 3 May 2026 at 14:05".

export function whenText(iso: string, now: Date): string {
  const moment = new Date(iso);
  if (Number.isNaN(moment.getTime())) {
    return iso;
  }
  const clock = `at ${moment.getHours()}:${String(moment.getMinutes()).padStart(2, "0")}`;
  const days = Math.round((midnight(now) - midnight(moment)) / 86_400_000);
  if (days === 0 || days === 1) {
    return `${days === 0 ? "today" : "yesterday"} ${clock}`;
  }
  const day = moment.toLocaleDateString("en-GB", { day: "numeric", month: "long", year: "numeric" });
  return `on ${day} ${clock}`;
}

function midnight(date: Date): number {
  return new Date(date.getFullYear(), date.getMonth(), date.getDate()).getTime();
}
