"""A lesson to take home: its steps as pages of text and pictures (`document`), and a writer for each format."""
