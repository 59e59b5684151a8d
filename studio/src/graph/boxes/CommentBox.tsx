// A comment on the canvas: text that belongs to no element. A double click or Enter edits it.

import { ActionIcon } from "@mantine/core";
import { IconPencil, IconTrash } from "@tabler/icons-react";
import { NodeResizeControl, type NodeProps } from "@xyflow/react";
import { memo, useState } from "react";

import { changeComment, removeComment, useNewComment } from "../../actions/commenting";
import type { CommentNode } from "../../architecture/nodes";

const LEAST = { width: 96, height: 40 };

export const CommentBox = memo(function CommentBox({ data: { comment, text } }: NodeProps<CommentNode>) {
  const fresh = useNewComment((state) => state.comment === comment);
  const [editing, setEditing] = useState(false);
  const [typed, setTyped] = useState(text);
  const edits = editing || fresh;
  const begin = () => {
    setTyped(text);
    setEditing(true);
  };
  const leave = (keep: boolean) => {
    setEditing(false);
    useNewComment.setState({ comment: "" });
    if (keep && typed !== text) {
      void changeComment(comment, { text: typed });
    }
  };
  return (
    <div className="graph-comment" onDoubleClick={begin}>
      {edits ? (
        <textarea
          className="nodrag nowheel"
          aria-label="Text of the comment"
          // biome-ignore lint/a11y/noAutofocus: the user asked to write
          autoFocus
          value={typed}
          onChange={(event) => setTyped(event.currentTarget.value)}
          onFocus={(event) => event.currentTarget.select()}
          onBlur={() => leave(true)}
          onKeyDown={(event) => {
            event.stopPropagation();
            if (event.key === "Escape" || (event.key === "Enter" && (event.ctrlKey || event.metaKey))) {
              leave(event.key === "Enter");
            }
          }}
        />
      ) : (
        <p>{text}</p>
      )}
      {!edits && (
        <div className="graph-comment-tools nodrag">
          <ActionIcon size={24} aria-label="Edit the comment" onClick={begin}>
            <IconPencil size={14} />
          </ActionIcon>
          <ActionIcon size={24} aria-label="Remove the comment" onClick={() => void removeComment(comment)}>
            <IconTrash size={14} />
          </ActionIcon>
        </div>
      )}
      <NodeResizeControl
        className="graph-comment-size"
        minWidth={LEAST.width}
        minHeight={LEAST.height}
        onResizeEnd={(_, { width, height }) => void changeComment(comment, { size: [width, height] })}
      />
    </div>
  );
});
