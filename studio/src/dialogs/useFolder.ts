// What lies in a folder below the root.

import { useEffect, useState } from "react";

import type { Folder, ListedProblem } from "../protocol";
import { socket } from "../socket";

type Listing = { folder: Folder | null; problem: ListedProblem | null };

const WAITING: Listing = { folder: null, problem: null };

export function useFolder(path: string): Listing {
  const [listing, setListing] = useState(WAITING);
  useEffect(() => {
    let wanted = true;
    void socket.ask({ type: "list_folder", path }).then(({ answer, folder }) => {
      if (wanted) {
        setListing({ folder, problem: answer.problems?.[0] ?? null });
      }
    });
    return () => {
      wanted = false;
    };
  }, [path]);
  return listing;
}
