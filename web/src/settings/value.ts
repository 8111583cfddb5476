// A setting's value as the controller writes it, and as a person edits it. Which one it is, the controller says.

import type { Setting } from '../api/types';

export type Kind = 'switch' | 'bits' | 'choice' | 'number' | 'text' | 'password' | 'address';

const kinds: Record<string, Kind> = {
  Bool: 'switch',
  Bitfield: 'bits',
  ExclusiveBitfield: 'bits',
  Axes: 'bits',
  Radio: 'choice',
  Integer: 'number',
  Decimal: 'number',
  Text: 'text',
  Password: 'password',
  Ipv4: 'address',
  IPv4: 'address',
};

/** What nobody has described is a text. */
export const kindOf = (setting: Setting): Kind => kinds[setting.type_name] ?? 'text';

export interface Option {
  value: number;
  title: string;
}

/** Bits or choices by name; 'N/A' and empty names are places that this controller does not use. */
export function optionsOf(setting: Setting, axes: readonly string[]): Option[] {
  const names = setting.type_name === 'Axes' ? axes : setting.format.split(',');
  return names
    .map((title, value) => ({ value, title: title.trim() }))
    .filter(({ title }) => title !== '' && title !== 'N/A');
}

/** Bits as a set; undefined where the value is no whole number. */
export function decodeBits(value: string): Set<number> | undefined {
  if (!/^\d+$/.test(value)) return undefined;
  const bits = new Set<number>();
  let rest = BigInt(value);
  for (let bit = 0; rest > 0n; bit++, rest >>= 1n) if ((rest & 1n) === 1n) bits.add(bit);
  return bits;
}

export function encodeBits(bits: Iterable<number>): string {
  let sum = 0n;
  for (const bit of new Set(bits)) sum |= 1n << BigInt(bit);
  return String(sum);
}

/** One bit more or less. Where bit 0 enables the others, none of them stays without it. */
export function flipBit(setting: Setting, value: string, bit: number): string {
  const bits = decodeBits(value) ?? new Set<number>();
  const isOn = bits.has(bit);
  if (isOn) bits.delete(bit);
  else bits.add(bit);
  if (setting.type_name === 'ExclusiveBitfield') {
    if (bit === 0 && isOn) bits.clear();
    else if (!isOn) bits.add(0);
  }
  return encodeBits(bits);
}

export type Problem =
  '' | 'notNumber' | 'notWhole' | 'tooSmall' | 'tooLarge' | 'tooShort' | 'tooLong' | 'notAddress' | 'notAscii';

/** What is surely wrong is said at once; the rest is for the server and the controller to judge. */
export function problemOf(setting: Setting, value: string): Problem {
  const kind = kindOf(setting);
  if (value === '' && setting.allow_null) return '';
  if (kind === 'number') return numberProblem(setting, value);
  if (kind === 'bits' || kind === 'choice' || kind === 'switch') return /^\d+$/.test(value) ? '' : 'notNumber';
  if (kind === 'address') return isAddress(value) ? '' : 'notAddress';
  return textProblem(setting, value);
}

function numberProblem(setting: Setting, value: string): Problem {
  if (!/^-?(\d+\.?\d*|\.\d+)$/.test(value)) return 'notNumber';
  if (setting.type_name === 'Integer' && !/^-?\d+$/.test(value)) return 'notWhole';
  const number = Number(value);
  if (number === 0 && setting.allow_null) return '';
  if (setting.min !== '' && number < Number(setting.min)) return 'tooSmall';
  if (setting.max !== '' && number > Number(setting.max)) return 'tooLarge';
  return '';
}

function textProblem(setting: Setting, value: string): Problem {
  if (!/^[\x20-\x7e]*$/.test(value)) return 'notAscii';
  if (setting.min !== '' && value.length < Number(setting.min)) return 'tooShort';
  if (setting.max !== '' && value.length > Number(setting.max)) return 'tooLong';
  return '';
}

const isAddress = (value: string): boolean => {
  const parts = value.split('.');
  return parts.length === 4 && parts.every((part) => /^\d{1,3}$/.test(part) && Number(part) <= 255);
};

/** Two spellings of one value are no change. */
export function isSame(setting: Setting, a: string, b: string): boolean {
  if (a === b) return true;
  if (kindOf(setting) !== 'number' || a.trim() === '' || b.trim() === '') return false;
  return Number(a) === Number(b);
}

/** A value for people: names instead of numbers. */
export function meaningOf(
  setting: Setting,
  value: string,
  axes: readonly string[],
  words: { on: string; off: string; none: string },
): string {
  const kind = kindOf(setting);
  if (kind === 'switch') return value === '1' ? words.on : words.off;
  if (kind === 'password') return value === '' ? words.none : '••••••';
  if (kind === 'choice') return optionsOf(setting, axes).find((one) => String(one.value) === value)?.title ?? value;
  if (kind !== 'bits') return setting.unit && value !== '' ? `${value} ${setting.unit}` : value || words.none;
  const bits = decodeBits(value);
  if (!bits) return value;
  const names = optionsOf(setting, axes).filter((one) => bits.has(one.value));
  return names.map((one) => one.title).join(', ') || words.none;
}
