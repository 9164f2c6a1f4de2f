"""The browser studio: `server.StudioServer` serves the page and the data of any `source.GraphSource`."""
