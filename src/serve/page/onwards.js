// Leads from the link with the token to the page, with what the link says of the view.

location.replace(`/${location.hash}`);
