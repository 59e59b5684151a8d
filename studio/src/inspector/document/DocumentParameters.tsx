// Document parameters: numbers with a name that drive parameters of elements.

import { ActionIcon, Menu, UnstyledButton } from "@mantine/core";
import { IconLink, IconLinkOff, IconTrash } from "@tabler/icons-react";
import { useState } from "react";

import type { DocumentParameterView, LinkView } from "../../protocol";
import { request } from "../../server/socket";
import { useStudio } from "../../server/store";
import { AddButton } from "../../widgets/AddButton";
import { DotsMenu } from "../../widgets/DotsMenu";
import { DocumentParameterAdding } from "../../forms/DocumentParameterAdding";
import { useDocumentParameterLook } from "../../state/controlLook";
import { PinItem } from "../../forms/PinItem";
import { NumberControl } from "../../forms/NumberControl";
import { useSetting } from "../../actions/setting";

export function DocumentParameters({ parameters }: { parameters: DocumentParameterView[] }) {
  const [adding, setAdding] = useState(false);
  return (
    <section className="parameters" aria-label="Document parameters">
      <h3>
        Document parameters
        <AddButton aria-label="Add a document parameter" onClick={() => setAdding(true)} />
      </h3>
      {adding && <DocumentParameterAdding onDone={() => setAdding(false)} />}
      {parameters.map((parameter) => (
        <Item key={parameter.name} parameter={parameter} />
      ))}
      {parameters.length === 0 && !adding && (
        <p className="dim hint">
          None. One document parameter can drive parameters of several elements together.
        </p>
      )}
    </section>
  );
}

function Item({ parameter }: { parameter: DocumentParameterView }) {
  const { name, value, links } = parameter;
  const [linking, setLinking] = useState(false);
  const look = useDocumentParameterLook(parameter);
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
          <PinItem element="" path={name} />
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
    <li className="flow">
      <UnstyledButton className="link-path fine one-line" title={path} onClick={() => select([link.element])}>
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
