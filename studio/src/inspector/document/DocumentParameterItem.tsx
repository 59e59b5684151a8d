// One document parameter: its value and its links.

import { ActionIcon, Menu, UnstyledButton } from "@mantine/core";
import { IconLink, IconLinkOff, IconPin, IconPinnedOff, IconTrash } from "@tabler/icons-react";
import { useState } from "react";

import { isAt, keepPins, pin, pinsOf, withoutPin } from "../../pins/pin";
import type { DocumentParameterView, LinkView } from "../../protocol";
import { request } from "../../socket";
import { useStudio } from "../../store";
import { DotsMenu } from "../../widgets/DotsMenu";
import { DocumentParameterAdding } from "./DocumentParameterAdding";
import { useDocumentParameterLook } from "../parameters/controlLook";
import { NumberControl } from "../numbers/NumberControl";
import { useSetting } from "../parameters/setting";

export function DocumentParameterItem({ documentParameter }: { documentParameter: DocumentParameterView }) {
  const { name, value, links } = documentParameter;
  const pinned = useStudio((state) => pinsOf(state.document?.layout).some((pin) => isAt(pin, "", name)));
  const [linking, setLinking] = useState(false);
  const look = useDocumentParameterLook(documentParameter);
  const setting = useSetting<number | null>("", name, value, look.cost);
  return (
    <div className="row" data-document-parameter={name}>
      <div className="row-label">
        <span className="row-name one-line" title={name}>
          {name}
        </span>
      </div>
      <div className="row-tools">
        <DotsMenu label={`More for ${name}`}>
          {pinned ? (
            <Menu.Item
              leftSection={<IconPinnedOff size={14} />}
              onClick={() => keepPins((pins) => withoutPin(pins, "", name))}
            >
              Unpin from Sliders
            </Menu.Item>
          ) : (
            <Menu.Item leftSection={<IconPin size={14} />} onClick={() => pin("", name)}>
              Pin to Sliders
            </Menu.Item>
          )}
          <Menu.Item leftSection={<IconLink size={14} />} onClick={() => setLinking(true)}>
            Drive another parameter…
          </Menu.Item>
          <Menu.Item
            leftSection={<IconTrash size={14} />}
            onClick={() => void request({ type: "remove_document_parameter", name })}
          >
            Remove
          </Menu.Item>
        </DotsMenu>
      </div>
      <div className="row-control">
        <NumberControl label={name} setting={setting} range={look.range} rangeKey={name} unit={look.unit} />
        <ul className="links" aria-label={`Driven by ${name}`}>
          {links.map((link) => (
            <Driven key={`${link.element} ${link.parameter}`} link={link} />
          ))}
          {links.length === 0 && <li className="dim">drives nothing</li>}
        </ul>
        {linking && <DocumentParameterAdding name={name} onDone={() => setLinking(false)} />}
      </div>
    </div>
  );
}

function Driven({ link }: { link: LinkView }) {
  const element = useStudio((state) => state.elements.get(link.element));
  const select = useStudio((state) => state.select);
  const path = `${element?.path ?? link.element}.${link.parameter}`;
  return (
    <li>
      <UnstyledButton className="link-path one-line" title={path} onClick={() => select([link.element])}>
        {path}
      </UnstyledButton>
      <ActionIcon
        size={16}
        aria-label={`Unlink ${path}`}
        onClick={() => void request({ type: "unlink", element: link.element, parameter: link.parameter })}
      >
        <IconLinkOff size={11} />
      </ActionIcon>
    </li>
  );
}
