from . import output as output
from . import process as process
from . import text as text
from .output import basic_output_filter as basic_output_filter
from .output import expect_output as expect_output
from .output import expected_output_from_file as expected_output_from_file
from .process import ProcessProxy as ProcessProxy
from .process import launch_process as launch_process
