// Questions and uploads over HTTP. Every refusal becomes an Error with the server's own sentence.

const root = '/api/v1';

export class ApiError extends Error {
  constructor(
    readonly status: number,
    sentence: string,
  ) {
    super(sentence);
  }
}

async function failure(response: Response): Promise<ApiError> {
  try {
    const body = (await response.json()) as { error?: { sentence?: string }; sentence?: string };
    return new ApiError(response.status, body.error?.sentence ?? body.sentence ?? `HTTP ${response.status}`);
  } catch {
    return new ApiError(response.status, `HTTP ${response.status}`);
  }
}

async function request<T>(path: string, init: RequestInit = {}): Promise<T> {
  const response = await fetch(root + path, init);
  if (!response.ok) throw await failure(response);
  const text = await response.text();
  return (text ? JSON.parse(text) : undefined) as T;
}

export const get = <T>(path: string, signal?: AbortSignal): Promise<T> => request<T>(path, { signal });

export const post = <T>(path: string, body: unknown): Promise<T> =>
  request<T>(path, {
    method: 'POST',
    headers: { 'content-type': 'application/json' },
    body: JSON.stringify(body),
    keepalive: true,
  });

export const remove = (path: string): Promise<void> => request<void>(path, { method: 'DELETE' });

/** fetch() tells no progress of what it sends, XMLHttpRequest does. */
export function upload<T>(path: string, file: File, onProgress: (share: number) => void): Promise<T> {
  return new Promise((resolve, reject) => {
    const call = new XMLHttpRequest();
    call.open('POST', root + path);
    call.setRequestHeader('content-type', 'application/octet-stream');
    call.upload.onprogress = (event) => onProgress(event.total > 0 ? event.loaded / event.total : 0);
    call.onerror = () => reject(new ApiError(0, 'The file did not reach the server.'));
    call.onload = () => {
      const body = JSON.parse(call.responseText || '{}') as { error?: { sentence?: string } };
      if (call.status < 300) resolve(body as T);
      else reject(new ApiError(call.status, body.error?.sentence ?? `HTTP ${call.status}`));
    };
    call.send(file);
  });
}
