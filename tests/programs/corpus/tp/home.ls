/PROG  HOME
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "";
LINE_COUNT	= 5;
TCD:  STACK_SIZE	= 0;
DEFAULT_GROUP	= 1,*,*,*,*;
/MN
   1:J P[1:HOME] 100% FINE    ;
   2:J P[2:HOMEPLATE] 100% FINE    ;
   3:  WAIT DI[1]=ON TIMEOUT,LBL[99]    ;
   4:J P[1] 100% FINE    ;
   5:  LBL[99]    ;
/POS
P[1:"HOME"]{
   GP1:
	UF : 0, UT : 1,	
	J1=    10.000 deg,	J2=   -20.000 deg,	J3=    30.000 deg,
	J4=     0.000 deg,	J5=   -45.000 deg,	J6=     5.000 deg
};
P[2:"HOMEPLATE"]{
   GP1:
	UF : 0, UT : 1,	
	J1=    10.000 deg,	J2=   -20.000 deg,	J3=    30.000 deg,
	J4=     0.000 deg,	J5=   -45.000 deg,	J6=     5.000 deg
};
/END
