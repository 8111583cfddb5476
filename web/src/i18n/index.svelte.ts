// Words for people, in the language of this screen. {name} in a message is filled in.

import { prefs } from '../state/prefs.svelte';
import { de } from './de';
import { en } from './en';

export type MessageKey = keyof typeof en;

const dictionaries: Record<string, Record<MessageKey, string>> = { en, de };

export function fill(message: string, values: Record<string, string | number>): string {
  return message.replace(/\{(\w+)\}/g, (whole, name: string) => String(values[name] ?? whole));
}

export function t(key: MessageKey, values: Record<string, string | number> = {}): string {
  return fill(dictionaries[prefs.language]?.[key] ?? en[key], values);
}
