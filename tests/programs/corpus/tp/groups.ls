/PROG  GROUPS
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "";
LINE_COUNT	= 1;
TCD:  STACK_SIZE	= 0;
DEFAULT_GROUP	= 1,*,*,*,*;
/MN
   1:J P[1] 100% FINE    ;
/POS
P[1]{
   GP1:
	UF : 0, UT : 1,	
	J1=    10.000 deg,	J2=   -20.000 deg,	J3=    30.000 deg,
	J4=     0.000 deg,	J5=   -45.000 deg,	J6=     5.000 deg
   GP2:
	UF : 0, UT : 1,	
	J1=    90.000 deg,	J2=     0.000 deg
};
/END
