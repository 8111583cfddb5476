// A virtual controller that can be poked, a daemon that owns it, and a page that shows it.
import { type ChildProcess, spawn } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { connect } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { type Page, test as base, expect } from '@playwright/test';

const kerf = process.env.KERF ?? 'build/kerf';

/** Quick axes that home, 100 mm long. */
const settings: Record<string, string> = {
  '20': '1', '22': '1', '24': '3000', '25': '6000', '26': '10', '27': '1',
  '100': '250', '101': '250', '102': '250', '110': '6000', '111': '6000', '112': '6000',
  '120': '1000', '121': '1000', '122': '1000', '130': '100', '131': '100', '132': '100',
};

/** Goes out and in through one row after the other. */
export function zigzag(rows: number): string {
  const lines = ['G21 G90 G94', 'G0 Z5', 'M3 S1000', 'G1 Z-1 F500'];
  for (let row = 1; row <= rows; ++row) lines.push(`G1 X${row % 2 ? 30 : 0} F3000`, `Y${(row * 0.2).toFixed(1)}`);
  return [...lines, 'G0 Z5', 'M5', 'M30', ''].join('\n');
}

async function output(process: ChildProcess, pattern: RegExp): Promise<RegExpMatchArray> {
  let text = '';
  return new Promise((resolve, reject) => {
    const timer = setTimeout(() => reject(new Error(`'${pattern}' was not printed: ${text}`)), 20_000);
    process.stdout!.on('data', (piece) => {
      text += piece;
      const found = text.match(pattern);
      if (!found) return;
      clearTimeout(timer);
      resolve(found);
    });
    process.on('exit', () => reject(new Error(`it ended: ${text}`)));
  });
}

export class Bench {
  readonly folder = mkdtempSync(join(tmpdir(), 'kerf-browser-'));
  private controller?: ChildProcess;
  private daemon?: ChildProcess;
  machineUrl = '';
  url = '';

  async start(personality: string, speed = '2') {
    const file = join(this.folder, 'settings');
    writeFileSync(file, Object.entries(settings).map(([id, value]) => `$${id}=${value}\n`).join(''));
    const options = ['virtual', '-p', personality, '--speed', speed, '--listen', '127.0.0.1:0', '--settings', file];
    this.controller = spawn(kerf, [...options, '--control', `unix:${join(this.folder, 'control')}`]);
    this.machineUrl = (await output(this.controller, /tcp:\/\/127\.0\.0\.1:\d+/))[0];
    await this.serve();
  }

  async serve(port = '0') {
    const options = ['serve', '--listen', `127.0.0.1:${port}`, '--state', join(this.folder, 'state')];
    this.daemon = spawn(kerf, [...options, '-m', this.machineUrl]);
    this.url = (await output(this.daemon, /http:\/\/127\.0\.0\.1:\d+/))[0];
  }

  /** Without a word, as a power cut would. */
  async killDaemon() {
    const gone = new Promise((resolve) => this.daemon!.on('exit', resolve));
    this.daemon!.kill('SIGKILL');
    await gone;
  }

  /** What docs/virtual_controller.md has: `limit X on`, `link cut`. */
  async order(line: string) {
    await new Promise<void>((resolve, reject) => {
      const socket = connect(join(this.folder, 'control'));
      socket.on('data', (answer) => (answer.toString().startsWith('ok') ? resolve() : reject(new Error(`${line}: ${answer}`))));
      socket.on('error', reject);
      socket.write(`${line}\n`);
    });
  }

  async state(): Promise<Record<string, any>> {
    const reply = await (await fetch(`${this.url}/api/v1/state`)).json();
    return Object.values(reply.state.machines)[0] as Record<string, any>;
  }

  async command(command: string, members: object) {
    const { state } = await (await fetch(`${this.url}/api/v1/state`)).json();
    const machine = Object.keys(state.machines)[0];
    const reply = await fetch(`${this.url}/api/v1/machines/${machine}/commands`, {
      method: 'POST',
      body: JSON.stringify({ command, ...members }),
    });
    expect((await reply.json()).outcome).toBe('Accepted');
  }

  async upload(name: string, text: string) {
    const reply = await fetch(`${this.url}/api/v1/programs?name=${name}`, { method: 'POST', body: text });
    expect(reply.status).toBe(201);
  }

  async position(): Promise<number[]> {
    return (await this.state()).snapshot.machine_position_mm;
  }

  end() {
    this.daemon?.kill('SIGKILL');
    this.controller?.kill('SIGKILL');
    rmSync(this.folder, { recursive: true, force: true });
  }
}

export const test = base.extend<{ bench: Bench }>({
  // eslint-disable-next-line no-empty-pattern
  bench: async ({}, use) => {
    const bench = new Bench();
    await use(bench);
    bench.end();
  },
});

export { expect };

/** Keeps a button pressed until it acts. */
export async function hold(page: Page, name: string | RegExp, within = page.locator('body')) {
  const button = within.getByRole('button', { name, exact: typeof name === 'string' }).first();
  await button.hover();
  await page.mouse.down();
  await page.waitForTimeout(1000);
  await page.mouse.up();
}

export function stateWord(page: Page) {
  return page.getByTestId('state');
}

