"""What the build with run-time checks leaves to the release build."""
import os
import unittest

# Long tests whose lines of the program shorter ones reach too: run-time checks would see no more in them.
release_only = unittest.skipIf(os.environ.get('STRICT') == 'ON', 'the release build runs it')
