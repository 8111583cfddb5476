// Settings as the controller told them, and what is changed on the screen but not yet written.

import { get } from '../api/http';
import type { Setting, SettingGroup, SettingsVersion } from '../api/types';
import { isSame, problemOf } from './value';

interface Told {
  settings: Setting[];
  groups: SettingGroup[];
}

export class SettingsDraft {
  settings = $state.raw<Setting[]>([]);
  groups = $state.raw<SettingGroup[]>([]);
  versions = $state.raw<SettingsVersion[]>([]);
  changed = $state<Record<string, string>>({});
  problem = $state('');
  loading = $state(true);

  readonly changes = $derived(this.settings.filter((one) => one.id in this.changed));
  readonly isSound = $derived(this.changes.every((one) => problemOf(one, this.changed[one.id] ?? '') === ''));

  constructor(private readonly machine: string) {}

  async load(): Promise<void> {
    const at = `/machines/${encodeURIComponent(this.machine)}/settings`;
    this.loading = true;
    try {
      const told = await get<Told>(at);
      this.settings = told.settings;
      this.groups = told.groups ?? [];
      this.problem = '';
      this.versions = await get<SettingsVersion[]>(`${at}/history`);
    } catch (error) {
      this.problem = (error as Error).message;
    } finally {
      this.loading = false;
    }
  }

  valueOf(setting: Setting): string {
    return this.changed[setting.id] ?? setting.value;
  }

  change(setting: Setting, value: string): void {
    if (isSame(setting, value, setting.value)) this.forget(setting.id);
    else this.changed[setting.id] = value;
  }

  forget(id: string): void {
    delete this.changed[id];
  }

  forgetAll(): void {
    this.changed = {};
  }

  find(words: string): Setting[] {
    const wanted = words.trim().toLowerCase().replace(/^\$/, '');
    if (!wanted) return this.settings;
    return this.settings.filter(
      (one) => one.id.toLowerCase() === wanted || `${one.name} ${one.help} ${one.group}`.toLowerCase().includes(wanted),
    );
  }
}
