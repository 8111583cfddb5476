// Fetches and reads a toolpath away from the page, so that the page never waits for it.

import { SectionReader, type Section } from './decoder';
import { strokesOf, type Strokes } from './strokes';

export type FromWorker =
  | { type: 'begin'; tolerances: number[] }
  | { type: 'strokes'; strokes: Strokes }
  | { type: 'done'; bounds: number[]; vertices: number }
  | { type: 'failed'; sentence: string };

const say = (message: FromWorker, transfer: Transferable[] = []) =>
  (self as unknown as { postMessage: (m: FromWorker, t: Transferable[]) => void }).postMessage(message, transfer);

function tell(section: Section): void {
  if (section.tag === 'KTP1') say({ type: 'begin', tolerances: section.tolerances });
  else if (section.tag === 'DONE') say({ type: 'done', bounds: section.bounds, vertices: section.vertices });
  else if (section.tag === 'CHNK') {
    const strokes = strokesOf(section.chunk);
    const { positions, lines, kinds, indices } = strokes;
    say({ type: 'strokes', strokes }, [positions.buffer, lines.buffer, kinds.buffer, indices.buffer]);
  }
}

async function read(url: string): Promise<void> {
  const response = await fetch(url);
  const reader = response.body?.getReader();
  if (!response.ok || !reader) throw new Error(`HTTP ${response.status}`);
  const sections = new SectionReader();
  for (let part = await reader.read(); !part.done; part = await reader.read()) sections.push(part.value).forEach(tell);
  if (!sections.finished) throw new Error('The path ended early.');
}

self.onmessage = (event: MessageEvent<string>) => {
  read(event.data).catch((error: unknown) => say({ type: 'failed', sentence: String((error as Error).message) }));
};
