"""Every paper in the folder has a description, and its jobs give rows with different keys."""

from __future__ import annotations

import json
import pickle
from pathlib import Path

import pytest

from deodar.errors import UnknownName
from deodar_papers import papers


@pytest.mark.parametrize("name", list(papers.PAPERS))
@pytest.mark.parametrize("quick", [True, False])
def test_a_paper_has_the_parts_that_the_command_uses(name, quick):
    paper = papers.PAPERS[name]
    assert paper.HELP and "\n" not in paper.HELP and paper.__doc__
    jobs = paper.jobs(quick)
    keys = [key for job in jobs for key in job.keys]
    assert len(keys) == len(set(keys)) and all(job.cost > 0 for job in jobs)
    copied = pickle.loads(pickle.dumps(jobs))  # they are sent to workers
    assert [job.arguments for job in copied] == [dict(json.loads(json.dumps(job.arguments))) for job in jobs]
    assert json.loads(json.dumps(paper.about(quick))) == json.loads(json.dumps(paper.about(quick)))
    named = {name for entry in paper.BY_CONDITION for name in paper.about(quick)[entry]}
    assert named == {key.rpartition("/")[0] for key in keys}


@pytest.mark.parametrize("name", list(papers.PAPERS))
def test_without_runs_every_claim_is_undecided(name):
    report = papers.PAPERS[name].report({}, True)
    assert report.claims and not report.figures
    assert all(c.holds is None for c in report.claims)
    names = [c.name for c in report.claims]
    assert len(names) == len(set(names))


def test_an_unknown_paper_suggests_the_nearest():
    with pytest.raises(UnknownName, match="Did you mean 'spa'"):
        papers.PAPERS["sba"]


def test_the_story_and_each_paper_of_deodar_with_a_file_demo_are_demonstrations():
    with_demo = [n for n, p in papers.PAPERS.items() if Path(str(p.__file__)).with_name("demo.py").is_file()]
    assert list(papers.demos()) == ["story", *with_demo] and "spa" in with_demo
    assert all(demo.HELP and demo.run and demo.arguments for demo in papers.demos().values())


def test_a_paper_and_its_files_are_imported_when_they_are_used():
    assert papers.saliency.scenes.photographs and papers.spa.narrative.run
    with pytest.raises(AttributeError, match="no attribute 'salience'"):
        papers.salience  # noqa: B018
