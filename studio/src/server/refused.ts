// A studio that was restarted may have another token. The browser does not say why a socket failed to
// open, but it does of a request.

export async function isRefused(
  ask: (path: string, how: RequestInit) => Promise<{ status: number }> = fetch,
): Promise<boolean> {
  try {
    return (await ask("..", { method: "HEAD", cache: "no-store" })).status === 401;
  } catch {
    return false; // no answer
  }
}
