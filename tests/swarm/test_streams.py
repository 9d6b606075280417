"""Streams of random numbers: independent, repeatable, and continued where they were left."""

import numpy as np

from armscope.swarm.streams import set_sfc64_states, sfc64_states, spawn_generators


def test_equal_seeds_give_equal_streams_and_children_differ():
    first, again = spawn_generators(7, 3), spawn_generators(7, 3)
    numbers = [g.random(4).tolist() for g in first]
    assert numbers == [g.random(4).tolist() for g in again]
    assert len({tuple(each) for each in numbers}) == 3


def test_a_stream_does_not_depend_on_how_many_are_spawned():
    assert spawn_generators(7, 2)[1].random() == spawn_generators(7, 9)[1].random()


def test_a_state_written_back_continues_the_stream():
    ours, theirs = spawn_generators(7, 2), spawn_generators(7, 2)
    for generator in theirs:
        generator.random(5)
    set_sfc64_states(ours, sfc64_states(theirs))
    assert np.array_equal([g.random() for g in ours], [g.random() for g in theirs])
