// Which page is shown: it stands in the address, so that a reload and the back key do what they should.

const pages = ['control', 'jobs', 'machine'] as const;
export type Page = (typeof pages)[number];

const read = (): string[] => location.hash.replace(/^#\/?/, '').split('/');

class Route {
  private parts = $state(read());
  readonly page = $derived<Page>(pages.find((page) => page === this.parts[0]) ?? 'control');
  readonly part = $derived(this.parts[1] ?? '');

  constructor() {
    window.addEventListener('hashchange', () => (this.parts = read()));
  }

  go(page: Page, part = ''): void {
    location.hash = part ? `#/${page}/${part}` : `#/${page}`;
  }
}

export const route = new Route();
export { pages };
