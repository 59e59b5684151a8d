// A kind that is dragged from the list of elements to the canvas.

const TYPE = "application/x-deodar-kind";

export function carry(transfer: DataTransfer, kind: string): void {
  transfer.setData(TYPE, kind);
  transfer.effectAllowed = "copy";
}

export const isCarried = (transfer: DataTransfer): boolean => transfer.types.includes(TYPE);

export const carried = (transfer: DataTransfer): string => transfer.getData(TYPE);
