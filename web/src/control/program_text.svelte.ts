// Lines of a program in windows, as they are looked at: a file of millions of lines is never here as a whole.

import { get } from '../api/http';

export const windowLines = 500;
const windowsKept = 24;

export class ProgramText {
  private windows = $state.raw<Readonly<Record<number, string[]>>>({});
  private order: number[] = [];
  private asked: number[] = [];

  constructor(private readonly id: string) {}

  /** Undefined until it has come; asking for it brings it. */
  line(number: number): string | undefined {
    const at = Math.floor((number - 1) / windowLines);
    return this.windows[at]?.[(number - 1) % windowLines];
  }

  want(first: number, last: number): void {
    for (let at = Math.floor((first - 1) / windowLines); at <= Math.floor((last - 1) / windowLines); at++)
      if (!this.windows[at] && !this.asked.includes(at)) void this.bring(at);
  }

  private async bring(at: number): Promise<void> {
    this.asked.push(at);
    try {
      const { lines } = await get<{ lines: string[] }>(
        `/programs/${this.id}/text?first=${at * windowLines + 1}&count=${windowLines}`,
      );
      this.order = [...this.order.slice(-windowsKept), at];
      const kept = this.order.map((one): [number, string[]] => [one, this.windows[one] ?? lines]);
      this.windows = Object.fromEntries(kept);
    } catch {
      // Asked for again when it is looked at again.
    } finally {
      this.asked = this.asked.filter((one) => one !== at);
    }
  }
}
