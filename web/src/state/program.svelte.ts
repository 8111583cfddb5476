// What is known about the program on this machine: what the check found and how long each line takes.

import { get } from '../api/http';
import type { CheckResult, Estimate } from '../api/types';

class Program {
  check = $state.raw<CheckResult | undefined>();
  estimate = $state.raw<Estimate | undefined>();
  checking = $state(false);
  selectedLine = $state(0);
  /** Seconds into the job that the scrubber shows; negative when it follows the machine. */
  scrub_s = $state(-1);
  private asked = '';
  private id = '';
  private stopAsking: AbortController | undefined;

  /** Asked again when the program, the machine or its place changes. */
  look(id: string, machine: string, place: string): void {
    const wanted = id && machine ? `${id} ${machine} ${place}` : '';
    if (wanted === this.asked) return;
    this.asked = wanted;
    this.stopAsking?.abort();
    this.check = undefined;
    this.estimate = undefined;
    if (id !== this.id) {
      this.selectedLine = 0;
      this.scrub_s = -1;
    }
    this.id = id;
    if (wanted) void this.ask(id, machine);
  }

  private async ask(id: string, machine: string): Promise<void> {
    const stop = new AbortController();
    this.stopAsking = stop;
    this.checking = true;
    const at = `/programs/${id}`;
    const of = `?machine=${encodeURIComponent(machine)}`;
    const [check, estimate] = await Promise.allSettled([
      get<CheckResult>(`${at}/check${of}`, stop.signal),
      get<Estimate>(`${at}/estimate${of}`, stop.signal),
    ]);
    if (stop.signal.aborted) return;
    this.checking = false;
    this.check = check.status === 'fulfilled' ? check.value : undefined;
    this.estimate = estimate.status === 'fulfilled' ? estimate.value : undefined;
    if (check.status === 'rejected' && estimate.status === 'rejected') this.asked = '';
  }
}

export const program = new Program();

/** The line that executes `at_s` seconds into the job: the first that has not ended by then. */
export function lineAt(timeline: Estimate['timeline'], at_s: number): number {
  if (!timeline || timeline.lines.length === 0) return 0;
  let low = 0;
  let high = timeline.end_s.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((timeline.end_s[middle] ?? 0) < at_s) low = middle + 1;
    else high = middle;
  }
  return timeline.lines[low] ?? 0;
}

/** When line `line` has ended, seconds into the job. */
export function endOf(timeline: Estimate['timeline'], line: number): number {
  if (!timeline || timeline.lines.length === 0 || line <= 0) return 0;
  let low = 0;
  let high = timeline.lines.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((timeline.lines[middle] ?? 0) <= line) low = middle + 1;
    else high = middle;
  }
  return low > 0 ? (timeline.end_s[low - 1] ?? 0) : 0;
}
