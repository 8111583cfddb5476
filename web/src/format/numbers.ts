// Numbers for people. The API is always metric; inches exist only here.

export type Units = 'mm' | 'inch';

const mmPerInch = 25.4;

export const toShown = (mm: number, units: Units): number => (units === 'inch' ? mm / mmPerInch : mm);
export const fromShown = (shown: number, units: Units): number => (units === 'inch' ? shown * mmPerInch : shown);

function fixed(value: number, digits: number): string {
  const text = value.toFixed(digits);
  return Number(text) === 0 ? text.replace('-', '') : text;
}

/** Three places in mm, four in inches, as controllers and their operators do. A position nobody told is a dash. */
export function position(mm: number | undefined, units: Units): string {
  if (mm === undefined || !Number.isFinite(mm)) return '—';
  return fixed(toShown(mm, units), units === 'inch' ? 4 : 3);
}

export function feed(mm_per_min: number | undefined, units: Units): string {
  if (mm_per_min === undefined || !Number.isFinite(mm_per_min)) return '—';
  const shown = toShown(mm_per_min, units);
  return fixed(shown, units === 'inch' && shown < 100 ? 1 : 0);
}

export const feedUnit = (units: Units): string => (units === 'inch' ? 'in/min' : 'mm/min');
export const lengthUnit = (units: Units): string => (units === 'inch' ? 'in' : 'mm');

/** Hours only when there are any: 4:05, 1:02:09. */
export function duration(seconds: number | undefined): string {
  if (seconds === undefined || !Number.isFinite(seconds)) return '—';
  const whole = Math.max(0, Math.round(seconds));
  const [h, m, s] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60, whole % 60];
  const two = (n: number) => String(n).padStart(2, '0');
  return h > 0 ? `${h}:${two(m)}:${two(s)}` : `${m}:${two(s)}`;
}

export const count = (n: number, language: string): string => new Intl.NumberFormat(language).format(n);

export function size(bytes: number, language: string): string {
  const steps = ['B', 'kB', 'MB', 'GB'] as const;
  let step = 0;
  let value = bytes;
  while (value >= 1000 && step < steps.length - 1) {
    value /= 1000;
    step++;
  }
  const shown = new Intl.NumberFormat(language, { maximumFractionDigits: value < 10 && step > 0 ? 1 : 0 }).format(
    value,
  );
  return `${shown} ${steps[step]}`;
}

export function when(iso: string | undefined, language: string): string {
  const at = iso ? new Date(iso) : null;
  if (!at || Number.isNaN(at.getTime())) return '—';
  return new Intl.DateTimeFormat(language, { dateStyle: 'medium', timeStyle: 'short' }).format(at);
}

export function clock(iso: string, language: string): string {
  const at = new Date(iso);
  return Number.isNaN(at.getTime()) ? '' : new Intl.DateTimeFormat(language, { timeStyle: 'medium' }).format(at);
}

/** What a person typed, in mm; a comma is a decimal point. Undefined where it is no number. */
export function typedLength(text: string, units: Units): number | undefined {
  const plain = text.trim().replace(',', '.');
  if (!/^[+-]?(\d+\.?\d*|\.\d+)$/.test(plain)) return undefined;
  return fromShown(Number(plain), units);
}
