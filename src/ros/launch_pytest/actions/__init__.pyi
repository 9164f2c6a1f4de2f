from .ready import ReadyToTest as ReadyToTest
