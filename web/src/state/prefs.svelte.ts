// What this screen prefers. It stays on this screen: nothing here reaches a machine.

export type Theme = 'dark' | 'light' | 'goggle';
export type Units = 'mm' | 'inch';
export type Language = 'en' | 'de';

interface Kept {
  theme: Theme;
  units: Units;
  language: Language;
  machine: string;
  jogStep_mm: number;
  jogStep_inch: number;
  jogFeed: number;
  jogMode: 'step' | 'hold';
}

const key = 'kerf';

function kept(): Partial<Kept> {
  try {
    return JSON.parse(localStorage.getItem(key) ?? '{}') as Partial<Kept>;
  } catch {
    return {};
  }
}

const before = kept();
const german = typeof navigator !== 'undefined' && navigator.language?.startsWith('de');

class Prefs {
  theme = $state<Theme>(before.theme ?? 'dark');
  units = $state<Units>(before.units ?? 'mm');
  language = $state<Language>(before.language ?? (german ? 'de' : 'en'));
  machine = $state(before.machine ?? '');
  jogStep_mm = $state(before.jogStep_mm ?? 1);
  jogStep_inch = $state(before.jogStep_inch ?? 0.01);
  jogFeed = $state(before.jogFeed ?? 1000);
  jogMode = $state<'step' | 'hold'>(before.jogMode ?? 'hold');

  keep(): void {
    const { theme, units, language, machine, jogStep_mm, jogStep_inch, jogFeed, jogMode } = this;
    try {
      localStorage.setItem(
        key,
        JSON.stringify({ theme, units, language, machine, jogStep_mm, jogStep_inch, jogFeed, jogMode }),
      );
    } catch {
      // A browser that keeps nothing still shows everything.
    }
  }
}

export const prefs = new Prefs();
