import numpy as np

from daidalos.simulation.rendering.pool import Pool


def test_what_is_held_is_never_handed_out_again():
    pool = Pool()
    held = [pool.take((4, 4), np.float32) for _ in range(6)]
    assert len({id(array) for array in held}) == 6


def test_what_was_let_go_comes_again():
    pool = Pool()
    place = pool.take((4, 4), np.float32).ctypes.data
    assert pool.take((4, 4), np.float32).ctypes.data == place
    assert pool.take((4, 4), np.uint8).ctypes.data != place


def test_a_view_holds_its_array():
    pool = Pool()
    view = pool.take((4, 4), np.float32)[1:, :]
    memory = memoryview(pool.take((4, 4), np.float32))
    assert not np.shares_memory(view, memory)
    third = pool.take((4, 4), np.float32)
    assert not np.shares_memory(third, view)
    assert not np.shares_memory(third, memory)
