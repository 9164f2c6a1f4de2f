from .gtest import GTest as GTest
from .pytest import PyTest as PyTest
from .ready import ReadyToTest as ReadyToTest
from .test import Test as Test
