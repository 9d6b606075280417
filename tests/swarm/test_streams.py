"""Streams of random numbers: independent, repeatable, and continued where they were left."""

import numpy as np
import pytest

from armscope.swarm.streams import (
    BLOCK_WORDS,
    WEIGHT_UNIT,
    WeightStream,
    set_sfc64_states,
    sfc64_states,
    spawn_generators,
)


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


def test_weights_are_the_halves_of_the_generators_words():
    (generator,) = spawn_generators(7, 1)
    words = spawn_generators(7, 1)[0].bit_generator.random_raw(2 * 3 * 4).reshape(2, 3, 4)
    stream = WeightStream([generator], (3, 4), 2)
    for of_iteration in words:
        r1, r2 = stream.draw()
        assert np.array_equal(r1[0], of_iteration % 2**32)
        assert np.array_equal(r2[0], of_iteration // 2**32)
        assert (r1 * WEIGHT_UNIT < 1).all()


def test_any_kind_of_generator_gives_weights_over_the_whole_range():
    for kind in (np.random.MT19937, np.random.PCG64, np.random.SFC64):
        weights = np.array(WeightStream([np.random.Generator(kind(1))], (500, 2), 1).draw()) * WEIGHT_UNIT
        assert np.allclose(weights.mean(axis=(1, 2, 3)), 0.5, atol=0.05)
        assert weights.max() > 0.99


@pytest.mark.parametrize("iterations_used", [0, 1, 3, 30])
def test_a_swarm_that_leaves_early_leaves_its_generator_where_it_stood(iterations_used):
    shape = (BLOCK_WORDS // 40, 10)  # so that four iterations are drawn at once
    generators, untouched = spawn_generators(7, 3), spawn_generators(7, 3)
    stream = WeightStream(generators, shape, 40)
    for _ in range(iterations_used):
        stream.draw()
    stream.keep(np.array([True, False, True]))
    untouched[1].bit_generator.random_raw(iterations_used * shape[0] * shape[1])
    assert generators[1].random() == untouched[1].random()
    remaining = WeightStream([untouched[0], untouched[2]], shape, 40)
    for _ in range(iterations_used):
        remaining.draw()
    for _ in range(iterations_used, 40):
        assert np.array_equal(stream.draw(), remaining.draw())
    assert generators[2].random() == untouched[2].random()
