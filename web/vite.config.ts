import { svelte } from '@sveltejs/vite-plugin-svelte';
import { defineConfig } from 'vitest/config';
import { compressedAssets } from './tools/compressed_assets.js';

const daemon = process.env.KERF_DAEMON ?? 'http://127.0.0.1:8080';
// The daemon answers only pages of its own origin.
const proxy = { '/api': { target: daemon, ws: true, changeOrigin: true, headers: { origin: daemon } } };

export default defineConfig({
  plugins: [svelte(), compressedAssets()],
  resolve: process.env.VITEST ? { conditions: ['browser'] } : undefined,
  build: { target: 'es2022', sourcemap: false, chunkSizeWarningLimit: 700 },
  worker: { format: 'es' },
  server: { proxy },
  preview: { proxy },
  test: { environment: 'happy-dom', include: ['src/**/*.test.ts'] },
});
